// Where the mouse is to what comes after it was caught, in a real window.
#define GLFW_INCLUDE_NONE
#include "sample_game/input.hpp"

#include <GLFW/glfw3.h>
#include <backends/imgui_impl_glfw.h>
#include <imgui.h>

#include <memory>

#include "tests/editor/user.hpp"
#include "tests/tools/on_display.hpp"

namespace {

// All that comes in until nothing more does.
std::vector<sample::InputEvent> told(sample::Input& input) {
    std::vector<sample::InputEvent> events;
    for (int quiet = 0; quiet < 5; ++quiet) {
        glfwWaitEventsTimeout(.1);
        if (input.gui.waiting()) quiet = 0;
        input.gui.feed(events);
    }
    return events;
}

}  // namespace

TEST_CASE("what is pressed after the mouse was caught is pressed where its cursor is") {
    if (!std::getenv("ESPALIER_ON_DISPLAY")) {
        ::setenv("ESPALIER_ON_DISPLAY", "1", 1);
        if (!passesOnDisplay("what is pressed after the mouse was caught*", {"xdotool"}))
            MESSAGE("xvfb-run or xdotool isn't installed; skipped");
        ::unsetenv("ESPALIER_ON_DISPLAY");
        return;
    }
    const Glfw glfw;
    REQUIRE(glfw.up);
    glfwWindowHint(GLFW_CLIENT_API, GLFW_NO_API);
    const std::unique_ptr<GLFWwindow, void (*)(GLFWwindow*)> window(
        glfwCreateWindow(200, 150, "test", nullptr, nullptr), glfwDestroyWindow);
    REQUIRE(window);
    const Gui gui;
    sample::Input input(window.get());
    ImGui_ImplGlfw_InitForVulkan(window.get(), false);
    glfwSetWindowPos(window.get(), 0, 0);
    glfwFocusWindow(window.get());
    const auto last = [&] {
        const std::vector<sample::InputEvent> events = told(input);
        REQUIRE(!events.empty());
        const auto& event = std::get<sample::PointerEvent>(events.back());
        return std::pair(event.x, event.y);
    };
    REQUIRE(run("xdotool mousemove 50 60").code == 0);
    CHECK(last() == std::pair(50.f, 60.f));
    input.catchMouse(true);
    REQUIRE(run("xdotool mousemove_relative 40 30").code == 0);
    CHECK(last() != std::pair(50.f, 60.f));
    input.catchMouse(false);
    CHECK(last() == std::pair(50.f, 60.f));
    REQUIRE(run("xdotool click 1").code == 0);
    CHECK(last() == std::pair(50.f, 60.f));
    ImGui_ImplGlfw_Shutdown();
}
