// The panel: tools and seeds, a slider for every parameter of every grammar, the view, counts and timings.
#include "sample_game/panel.hpp"

#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>

namespace sample {
namespace {

constexpr float kPanelWidth = 320;
const ImVec4 kErrorColour{1, .55f, .45f, 1};

std::string grouped(uint64_t value) {
    std::string text = std::to_string(value);
    for (int at = int(text.size()) - 3; at > 0; at -= 3) text.insert(size_t(at), ",");
    return text;
}

float encodeSrgb(float v) {
    return v <= .0031308f ? 12.92f * v : 1.055f * std::pow(v, 1 / 2.4f) - .055f;
}
float decodeSrgb(float v) {
    return v <= .04045f ? v / 12.92f : std::pow((v + .055f) / 1.055f, 2.4f);
}

// "%.2f m": as many digits as the range asks for; a unit may hold a percent sign.
std::string formatOf(const EspParamInfo& param) {
    const float range = std::max(std::abs(param.low), std::abs(param.high));
    const int digits = param.kind == ESP_PARAM_INT ? 0
                       : range < .1f               ? 4
                       : range < 1.5f              ? 3
                       : range < 15                ? 2
                       : range < 150               ? 1
                                                   : 0;
    std::string format = param.low > 0 && param.high / param.low > 200 ? "%.3g" : "%." + std::to_string(digits) + "f";
    if (param.unit[0]) format += " ";
    for (const char* c = param.unit; *c; ++c) format += *c == '%' ? std::string("%%") : std::string(1, *c);
    return format;
}

bool isInitial(const EspParamInfo& param) {
    const int count = param.kind == ESP_PARAM_COLOUR ? 3 : 1;
    for (int i = 0; i < count; ++i)
        if (std::abs(param.value[i] - param.initial[i]) > 1e-6f * std::max(1.f, std::abs(param.initial[i])))
            return false;
    return true;
}

// One row. True: the value changed.
bool editParam(const EspParamInfo& param, float* value) {
    switch (param.kind) {
        case ESP_PARAM_BOOL: {
            bool on = value[0] != 0;
            const bool changed = ImGui::Checkbox("##value", &on);
            value[0] = on;
            return changed;
        }
        case ESP_PARAM_COLOUR: {
            float shown[3];
            for (int i = 0; i < 3; ++i) shown[i] = encodeSrgb(value[i]);
            if (!ImGui::ColorEdit3("##value", shown, ImGuiColorEditFlags_Float)) return false;
            for (int i = 0; i < 3; ++i) value[i] = decodeSrgb(shown[i]);
            return true;
        }
        default: {
            // Ranges over several decades, such as 0.02 to 20, get a slider by ratio.
            const bool wide = param.low > 0 && param.high / param.low > 200;
            const ImGuiSliderFlags flags =
                ImGuiSliderFlags_AlwaysClamp | (wide ? ImGuiSliderFlags_Logarithmic : ImGuiSliderFlags_None);
            return ImGui::SliderFloat("##value", value, param.low, param.high, formatOf(param).c_str(), flags);
        }
    }
}

void params(EspContext* context, EspGrammar grammar, PanelState& state) {
    const uint32_t count = espParamCount(context, grammar);
    for (uint32_t i = 0; i < count; ++i) {
        EspParamInfo param;
        if (espParamInfo(context, grammar, i, &param) != ESP_OK) continue;
        ImGui::PushID(int(i));
        ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing,
                            {ImGui::GetStyle().ItemSpacing.x, ImGui::GetStyle().ItemSpacing.y / 3});
        ImGui::TextUnformatted(param.label);
        ImGui::PopStyleVar();
        const float button = ImGui::GetFrameHeight();
        ImGui::SetNextItemWidth(ImGui::GetContentRegionAvail().x - button - ImGui::GetStyle().ItemSpacing.x);
        float value[3];
        std::memcpy(value, param.value, sizeof value);
        bool changed = editParam(param, value);
        if (ImGui::IsItemHovered() && !ImGui::IsItemActive())
            ImGui::SetTooltip("%s\nCtrl+click to type a value", param.name);
        if (!isInitial(param)) {
            ImGui::SameLine();
            if (ImGui::Button("\u21ba", {button, button})) {
                std::memcpy(value, param.initial, sizeof value);
                changed = true;
            }
            if (ImGui::IsItemHovered()) ImGui::SetTooltip("Back to the grammar's own value");
        }
        if (changed) {
            espSetParam(context, grammar, param.name, value, param.kind == ESP_PARAM_COLOUR ? 3 : 1);
            state.paramsChanged = true;
        }
        ImGui::PopID();
    }
}

// A grammar's file, told apart from others of the same file by its place.
std::string nameOf(const espalier::scene::Scene& scene, size_t index) {
    std::string name = std::filesystem::path(scene.grammars[index].file).stem().string();
    size_t before = 0;
    for (size_t i = 0; i < index; ++i) before += scene.grammars[i].file == scene.grammars[index].file;
    return before ? name + " (" + std::to_string(before + 1) + ")" : name;
}

void tools(const espalier::scene::Scene& scene, PanelState& state) {
    const float half = (ImGui::GetContentRegionAvail().x - ImGui::GetStyle().ItemSpacing.x) / 2;
    const auto toggle = [&](const char* label, Tool tool) {
        const bool on = state.tool == tool;
        if (on) ImGui::PushStyleColor(ImGuiCol_Button, ImGui::GetStyleColorVec4(ImGuiCol_ButtonActive));
        if (ImGui::Button(label, {half, 0})) state.tool = tool;
        if (on) ImGui::PopStyleColor();
    };
    toggle("Look  (Q)", Tool::look);
    ImGui::SameLine();
    toggle("Plant seeds  (S)", Tool::plant);
    if (state.tool == Tool::plant) ImGui::TextDisabled("Click on the model to plant");
    if (scene.grammars.size() > 1) {
        const std::string chosen = nameOf(scene, size_t(state.plantGrammar));
        ImGui::SetNextItemWidth(-1);
        if (ImGui::BeginCombo("##grammar", chosen.c_str())) {
            for (int i = 0; i < int(scene.grammars.size()); ++i) {
                if (ImGui::Selectable(nameOf(scene, size_t(i)).c_str(), i == state.plantGrammar))
                    state.plantGrammar = i;
            }
            ImGui::EndCombo();
        }
    }
    if (ImGui::Button("New random numbers  (R)", {-1, 0})) state.newNumbers = true;
    if (ImGui::Button("Clear seeds", {half, 0})) state.clearSeeds = true;
    ImGui::SameLine();
    if (ImGui::Button("Scene's seeds", {half, 0})) state.sceneSeeds = true;
}

void view(const espalier::scene::Scene& scene, PanelState& state) {
    const char* names[] = {"Shaded", "Charts", "Normals", "Levels of detail"};
    const std::string now = state.look.view == ESP_VIEW_LAYER ? "Layer: " + state.viewLayer : names[state.look.view];
    ImGui::TextUnformatted("View");
    ImGui::SetNextItemWidth(-1);
    if (ImGui::BeginCombo("##view", now.c_str())) {
        for (int i = 0; i < 4; ++i)
            if (ImGui::Selectable(names[i], state.look.view == EspView(i))) state.look.view = EspView(i);
        for (const std::string& layer : scene.layers)
            if (ImGui::Selectable(("Layer: " + layer).c_str(),
                                  state.look.view == ESP_VIEW_LAYER && state.viewLayer == layer)) {
                state.look.view = ESP_VIEW_LAYER;
                state.viewLayer = layer;
            }
        ImGui::EndCombo();
    }
    int walk = state.grow.walk;
    ImGui::TextUnformatted("Walk");
    ImGui::SameLine();
    if (ImGui::RadioButton("intrinsic", walk == ESP_WALK_INTRINSIC)) walk = ESP_WALK_INTRINSIC;
    ImGui::SameLine();
    if (ImGui::RadioButton("the paper's", walk == ESP_WALK_PAPER)) walk = ESP_WALK_PAPER;
    state.grow.walk = EspWalkMode(walk);
    bool shadows = state.look.shadows != 0;
    ImGui::Checkbox("Shadows", &shadows);
    state.look.shadows = shadows;
    ImGui::TextUnformatted("Exposure");
    ImGui::SetNextItemWidth(-1);
    ImGui::SliderFloat("##exposure", &state.look.exposure, -4, 4, "%.1f stops", ImGuiSliderFlags_AlwaysClamp);
}

// Over the picture at the right, where it is seen whatever part of the panel is.
void figures(float scale, const PanelState& state) {
    const ImGuiIO& io = ImGui::GetIO();
    const float margin = 12 * scale;
    ImGui::SetNextWindowPos({io.DisplaySize.x - margin, margin}, ImGuiCond_Always, {1, 0});
    ImGui::SetNextWindowSize({235 * scale, 0});
    ImGui::SetNextWindowBgAlpha(.72f);
    const ImGuiWindowFlags flags = ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoInputs |
                                   ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoFocusOnAppearing |
                                   ImGuiWindowFlags_AlwaysAutoResize;
    if (ImGui::Begin("figures", nullptr, flags)) {
        const auto row = [](const char* name, const std::string& value) {
            ImGui::TextDisabled("%s", name);
            ImGui::SameLine();
            ImGui::SetCursorPosX(ImGui::GetWindowContentRegionMax().x - ImGui::CalcTextSize(value.c_str()).x);
            ImGui::TextUnformatted(value.c_str());
        };
        const auto ms = [](double value) {
            char text[32];
            std::snprintf(text, sizeof text, "%.2f ms", value);
            return std::string(text);
        };
        ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, {8 * scale, 2 * scale});
        const EspStats& s = state.stats;
        row("Seeds", grouped(s.seeds));
        row("Branches", grouped(s.branches));
        row("Nodes", grouped(s.nodes));
        row("Leaves", grouped(s.leaves));
        row("Triangles drawn", grouped(s.drawnPolygons));
        row("at full detail", grouped(s.polygons));
        ImGui::Spacing();
        row("Expand", ms(s.expandMs));
        row("Emit", ms(s.emitMs));
        row("Draw", ms(s.drawMs));
        row("Frame", ms(state.frameMs));
        row("GPU memory", grouped(s.totalBytes >> 20) + " MiB");
        if (s.overflow) row("Ran out of room", grouped(s.overflow));
        if (s.stopped) row("Stopped by a limit", grouped(s.stopped));
        if (state.validation) row("Validation messages", grouped(state.validationMessages));
        ImGui::PopStyleVar();
    }
    ImGui::End();
}

void help(float scale, PanelState& state) {
    const ImGuiIO& io = ImGui::GetIO();
    ImGui::SetNextWindowPos({io.DisplaySize.x / 2, io.DisplaySize.y / 2}, ImGuiCond_Always, {.5f, .5f});
    ImGui::SetNextWindowSize({470 * scale, 0});
    const ImGuiWindowFlags flags = ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoMove |
                                   ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_AlwaysAutoResize;
    if (ImGui::Begin("Keys and mouse", &state.showHelp, flags)) {
        const char* rows[][2] = {{"Left or middle drag", "turn around the model"},
                                 {"Shift + drag, right drag", "move sideways"},
                                 {"Wheel", "nearer, further"},
                                 {"F", "show everything"},
                                 {"S, then click", "plant a seed"},
                                 {"Q, Esc", "back to looking"},
                                 {"R", "new random numbers for all seeds"},
                                 {"1 2 3 4", "shaded, charts, normals, levels of detail"},
                                 {"F2", "show or hide the panel"},
                                 {"F12", "write a screenshot"},
                                 {"Ctrl + Q", "quit"}};
        if (ImGui::BeginTable("keys", 2)) {
            for (const auto& row : rows) {
                ImGui::TableNextRow();
                ImGui::TableNextColumn();
                ImGui::TextUnformatted(row[0]);
                ImGui::TableNextColumn();
                ImGui::TextDisabled("%s", row[1]);
            }
            ImGui::EndTable();
        }
        ImGui::Spacing();
        ImGui::TextWrapped("A grammar grows anew when its file changes on disk.");
    }
    ImGui::End();
}

}  // namespace

float panelWidth(float scale, const PanelState& state) {
    return state.showPanel ? std::min(kPanelWidth * scale, ImGui::GetIO().DisplaySize.x) : 0;
}

void showPanel(EspContext* context, const espalier::scene::Scene& scene, float scale, PanelState& state) {
    if (state.showHelp) help(scale, state);
    if (!state.showPanel) return;
    figures(scale, state);
    const ImGuiIO& io = ImGui::GetIO();
    ImGui::SetNextWindowPos({0, 0});
    ImGui::SetNextWindowSize({panelWidth(scale, state), io.DisplaySize.y});
    const ImGuiWindowFlags flags = ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove |
                                   ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoBringToFrontOnFocus;
    if (ImGui::Begin("Espalier", nullptr, flags)) {
        ImGui::TextUnformatted(scene.name.c_str());
        ImGui::TextDisabled("%s", state.deviceName.c_str());
        for (size_t i = 0; i < state.errors.size(); ++i) {
            const std::string& error = state.errors[i];
            const auto here = state.errors.begin() + std::ptrdiff_t(i);
            if (!error.empty() && std::find(state.errors.begin(), here, error) == here) {
                ImGui::PushStyleColor(ImGuiCol_Text, kErrorColour);
                ImGui::TextWrapped("%s", error.c_str());
                ImGui::PopStyleColor();
            }
        }
        if (!state.message.empty()) ImGui::TextWrapped("%s", state.message.c_str());
        ImGui::Separator();
        tools(scene, state);
        for (size_t i = 0; i < scene.grammars.size(); ++i) {
            ImGui::PushID(int(i));
            if (ImGui::CollapsingHeader(nameOf(scene, i).c_str(), i == 0 ? ImGuiTreeNodeFlags_DefaultOpen : 0))
                params(context, scene.grammars[i].id, state);
            ImGui::PopID();
        }
        if (ImGui::CollapsingHeader("View", ImGuiTreeNodeFlags_DefaultOpen)) view(scene, state);
        ImGui::TextDisabled("F1 keys   F frame   F12 screenshot");
    }
    ImGui::End();
}

}  // namespace sample
