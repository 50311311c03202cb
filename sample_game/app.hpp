#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "tools/scene/scene.hpp"

namespace sample {

struct AppOptions {
    espalier::scene::Request request;
    std::vector<std::string> models;  // that come to the scene
    int width = 1280, height = 720;   // of the window, in screen coordinates
    bool sized = false;               // that was asked for: else the window is as it was last
    float uiScale = 0;                // of letters and panels, 1: as for 96 dpi; 0: as the display says
    bool validation = false;
    uint64_t frames = 0;   // ends after so many, 0: when the user closes the window
    bool turn = false;     // turns the view in each of `frames`, and tells how long one takes
    bool editor = false;   // begins in the editor
    double autosave = 60;  // seconds between two autosaves
    std::string record;    // begins with recording a run into this file
    static constexpr uint64_t kLeastTurn = 90;
    std::string screenshot;  // written after the last of `frames`
};

// Opens the window and runs until it is closed. Returns the program's exit code; what went wrong is on stderr.
int runApp(const AppOptions& options);

}  // namespace sample
