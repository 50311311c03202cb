#pragma once

// Test cases that open a window of their own. For files that have defined GLFW_INCLUDE_NONE.

#include <GLFW/glfw3.h>
#include <doctest/doctest.h>

#include <filesystem>
#include <string>

#include "tests/tools/program.hpp"

// The test case of this name once more, where there is a display. False: what makes one isn't installed, or one of the
// programs that it needs besides.
inline bool passesOnDisplay(const std::string& name, std::initializer_list<const char*> needs = {}) {
    for (const char* program : needs)
        if (run(std::string("command -v ") + program).code != 0) return false;
    if (run("command -v xvfb-run").code != 0) return false;
    const std::string self = std::filesystem::read_symlink("/proc/self/exe").string();
    const Ran ran = runOnDisplay("320x240", self + " -tc=\"" + name + "\"");
    CHECK_MESSAGE(ran.code == 0, ran.output);
    return true;
}

struct Glfw {
    const bool up = glfwInit() == GLFW_TRUE;
    ~Glfw() {
        if (up) glfwTerminate();
    }
};
