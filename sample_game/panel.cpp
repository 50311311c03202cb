// The panel at the left: one tool at a time with its settings, then what the scene is made of.
#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>
#include <vector>

#include "sample_game/field_tool.hpp"
#include "sample_game/panels.hpp"

namespace sample {
namespace {

using namespace espalier::document;

constexpr float kMorning = 10;  // when a day begins for a scene that had a light of its own

void toolButtons(Workspace& work) {
    struct Entry {
        const char *label, *key;
        Tool tool;
        const char* tip;
    };
    const Entry entries[] = {
        {"Look", "Q", Tool::look, "Turn around the scene by dragging"},
        {"Paint", "B", Tool::paint, "Paint a layer, such as where ivy grows"},
        {"Seeds", "S", Tool::seeds, "Plant, choose, move and turn seeds"},
        {"Path", "T", Tool::path, "Draw a line: ivy grows along it"},
        {"Branch", "P", Tool::branch, "Pick a branch: prune it, freeze its plant, see how it walked"},
        {"Roofs", "H", Tool::houses, "Choose a house: its roof, its outline"},
        {"Fields", "E", Tool::fields, "Place and turn the elements of a field that guides patterns"}};
    const float pad = 2 * work.scale, gap = ImGui::GetStyle().ItemSpacing.x / 2;
    ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, {pad, ImGui::GetStyle().FramePadding.y});
    ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, {gap, ImGui::GetStyle().ItemSpacing.y});
    // Only scenes with a town have roofs, only those with a grammar of patterns have fields.
    std::vector<Entry> shown;
    for (const Entry& entry : entries) {
        const bool roofs = entry.tool != Tool::houses || espHouseCount(work.context.get()) > 0;
        const bool fields = entry.tool != Tool::fields || !designedFields(work).empty();
        if (roofs && fields) shown.push_back(entry);
    }
    const auto textOf = [](const Entry& entry, bool keys) {
        return keys ? std::string(entry.label) + " " + entry.key : entry.label;
    };
    // What is left of the row besides its words, the same for each.
    const auto spare = [&](bool keys) {
        float room = ImGui::GetContentRegionAvail().x - gap * float(shown.size() - 1);
        for (const Entry& entry : shown) room -= ImGui::CalcTextSize(textOf(entry, keys).c_str()).x;
        return room / float(shown.size());
    };
    const bool keys = spare(true) > 2 * pad;
    const float more = std::max(spare(keys), 2 * pad);  // where that is too wide they take two rows
    for (const Entry& entry : shown) {
        const std::string text = textOf(entry, keys);
        const float width = std::floor(ImGui::CalcTextSize(text.c_str()).x + more);
        if (&entry != &shown.front()) sameLineIfRoom(width);
        if (chosenButton(text.c_str(), work.tool == entry.tool, {width, 0})) work.choose(entry.tool);
        toolTip((std::string(entry.tip) + "  (" + entry.key + ")").c_str());
    }
    ImGui::PopStyleVar(2);
}

}  // namespace

const char* viewTitle(EspView view) {
    switch (view) {
        case ESP_VIEW_SHADED:
            return "Shaded";
        case ESP_VIEW_CHARTS:
            return "Charts and links";
        case ESP_VIEW_NORMALS:
            return "Normals";
        case ESP_VIEW_LOD:
            return "Levels of detail";
        case ESP_VIEW_DEPTH:
            return "Branches from the seed";
        case ESP_VIEW_OVERDRAW:
            return "Overdraw";
        case ESP_VIEW_FIELD:
            return "Field";
        case ESP_VIEW_LAYER:
            break;
    }
    return "Layer";
}

void lightPanel(Workspace& work) {
    const auto& scene = work.scene();
    SetLight light{scene.hour, scene.look.exposure, scene.look.shadows != 0};
    bool own = light.hour == espalier::scene::kOwnSun;
    bool changed = checkBox("The scene's own light", &own);
    toolTip("As the scene's file says, or of a day, by its time");
    if (changed) light.hour = own ? espalier::scene::kOwnSun : kMorning;
    float hour = own ? kMorning : light.hour;
    const int minutes = int(std::lround(hour * 60));
    char text[16];
    std::snprintf(text, sizeof text, own ? "not set" : "%d:%02d", minutes / 60, minutes % 60);
    if (labelledSlider("Time", &hour, 0, 24, text, false, hoursOf)) light.hour = hour, changed = true;
    toolTip("Time of the day; typed, it may be 14:30");
    const uint32_t gesture = changed ? widgetGesture(work) : 0;
    bool exposed = labelledSlider("Exposure", &light.exposure, -4, 4, "%.1f stops");
    const uint32_t second = exposed ? widgetGesture(work) : 0;
    toolTip("One stop more is twice as bright");
    exposed |= checkBox("Shadows", &light.shadows);
    toolTip("Of models, plants and houses");
    if (changed || exposed) work.perform(light, changed ? gesture : second);

    rowLabel("View");
    const bool layer = scene.look.view == ESP_VIEW_LAYER;
    if (beginCombo("##view", layer ? scene.viewLayer.c_str() : viewTitle(scene.look.view))) {
        for (const EspView view : kViews)
            if (ImGui::Selectable(viewTitle(view), scene.look.view == view))
                work.perform(SetView{espalier::scene::nameOf(view), ""});
        for (const std::string& name : scene.layers)
            if (ImGui::Selectable(("Layer: " + name).c_str(), layer && scene.viewLayer == name))
                work.perform(SetView{"layer", name});
        for (const std::string& name : designedFields(work))
            if (ImGui::Selectable(("Field: " + name).c_str(),
                                  scene.look.view == ESP_VIEW_FIELD && scene.viewLayer == name))
                work.perform(SetView{"field", name});
        ImGui::EndCombo();
    }
    toolTip("What is shown of the scene  (1 to 6)");
    if (layer || scene.look.view == ESP_VIEW_FIELD) {
        if (labelledSlider("Opacity", &work.layout.layerOpacity, .05f, 1, "%.2f")) work.redraw = true;
        toolTip("Of what is shown over the model");
    }
    bool paper = scene.grow.walk == ESP_WALK_PAPER;
    if (checkBox("The paper's walk, to compare", &paper))
        work.perform(SetWalk{espalier::scene::nameOf(paper ? ESP_WALK_PAPER : ESP_WALK_INTRINSIC)});
    toolTip("Plants walk from texel to texel, as Buron 2015 does: they turn at seams");
}

void showPanel(Workspace& work) {
    if (!work.layout.panel) return;
    const float top = ImGui::GetFrameHeight(), bottom = ImGui::GetFrameHeight() + 4 * work.scale;
    ImGui::SetNextWindowPos({0, top});
    ImGui::SetNextWindowSize({work.panelUnits(), work.window.y - top - bottom});
    const float high = work.window.y - top - bottom;
    ImGui::SetNextWindowSizeConstraints({std::min(kLeastPanel * work.scale, work.panelUnits()), high},
                                        {kMostPanel * work.scale, high});
    const ImGuiWindowFlags flags = ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoMove |
                                   ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoBringToFrontOnFocus | kQuiet;
    static Tool shown = work.tool;
    if (ImGui::Begin("Espalier", nullptr, flags)) {
        // A drag of its edge.
        if (const float wide = ImGui::GetWindowWidth(); wide != work.panelUnits() && ImGui::IsMouseDown(0)) {
            work.layout.panelWidth = std::clamp(wide / work.scale, kLeastPanel, kMostPanel);
            work.redraw = true;
        }
        toolButtons(work);  // stays in sight while the rest is scrolled
        ImGui::BeginChild("rest", {0, 0}, false, kQuiet);
        if (std::exchange(shown, work.tool) != work.tool) ImGui::SetScrollY(0);  // what it has stands first
        // Of the scene, not of a tool or a grammar: found at once, and out of the way of the tool in hand.
        ImGui::PushID(work.tool == Tool::look ? "look" : "tool");
        const int open = work.tool == Tool::look ? ImGuiTreeNodeFlags_DefaultOpen : 0;
        if (ImGui::CollapsingHeader("Light and view", open)) lightPanel(work);
        ImGui::PopID();
        if (work.tool == Tool::paint) {
            layersPanel(work);
            ImGui::Separator();
            brushPanel(work);
        }
        if (work.tool == Tool::seeds || work.tool == Tool::path) seedsPanel(work);
        if (work.tool == Tool::branch) branchPanel(work);
        if (work.tool == Tool::houses) housesPanel(work);
        if (work.tool == Tool::fields) fieldsPanel(work);
        ImGui::Spacing();
        grammarsPanel(work);
        if (work.tool != Tool::paint && ImGui::CollapsingHeader("Layers")) layersPanel(work);
        if (!work.scene().seeds.empty() && ImGui::CollapsingHeader("Plants")) plantsPanel(work);
        if (!work.scene().surfaces.empty() && ImGui::CollapsingHeader("Models")) modelsPanel(work);
        if (espHouseCount(work.context.get()) > 0 && ImGui::CollapsingHeader("Houses")) houseList(work);
        ImGui::EndChild();
    }
    ImGui::End();
}

}  // namespace sample
