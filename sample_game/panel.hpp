#pragma once

#include <string>
#include <vector>

#include "plugin_api/espalier.h"
#include "tools/scene/scene.hpp"

namespace sample {

enum class Tool { look, plant };

// What the panel shows and changes. The application reads it after each frame.
struct PanelState {
    // Shown:
    std::string deviceName;
    std::string message;              // the latest good news, such as a written screenshot
    std::vector<std::string> errors;  // one a grammar, empty where it grows as written; the last: other errors
    EspStats stats{};
    double frameMs = 0;
    uint32_t validationMessages = 0;
    bool validation = false;

    // Changed by the user:
    Tool tool = Tool::look;
    int plantGrammar = 0;
    bool showHelp = false;
    bool showPanel = true;
    EspLook look{};
    std::string viewLayer;
    EspGrowDef grow{};

    // Asked for; the application answers and clears them:
    bool newNumbers = false, clearSeeds = false, sceneSeeds = false, frameAll = false, screenshot = false;
    bool paramsChanged = false;
};

// What the panel takes at the window's left, in ImGui's units.
float panelWidth(float scale, const PanelState& state);

// Lays out the panel at the window's left, the figures at its right and the help over it, between ImGui::NewFrame and
// Render. Parameters are set in the context at once. scale: of the display.
void showPanel(EspContext* context, const espalier::scene::Scene& scene, float scale, PanelState& state);

}  // namespace sample
