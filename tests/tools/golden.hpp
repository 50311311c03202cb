#pragma once

// Pictures that are stored beside the tests.

#include <doctest/doctest.h>

#include "tests/tools/program.hpp"

// Against tests/goldens/NAME.png, as anybody's test of frames would.
inline void checkGolden(const std::string& name, const std::string& picture) {
    const std::string golden = "tests/goldens/" + name + ".png", difference = "out/" + name + "_difference.png";
    const char* update = std::getenv("ESPALIER_UPDATE_GOLDENS");
    if (update && *update) {
        std::filesystem::copy_file(picture, golden, std::filesystem::copy_options::overwrite_existing);
        MESSAGE("written anew: ", golden);
    }
    REQUIRE(std::filesystem::exists(golden));
    std::filesystem::create_directories("out");
    const Ran alike = run(program("espalier-compare") + " " + golden + " " + picture + " --diff " + difference);
    CHECK_MESSAGE(alike.code == 0, alike.output, " see ", difference);
}
