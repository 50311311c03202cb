// The panel at the left: one tool at a time with its settings, then what the scene is made of.
#include <imgui.h>
#include <imgui_internal.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <utility>

#include "sample_game/panels.hpp"
#include "tools/scene/layers.hpp"

namespace sample {
namespace {

using namespace espalier::document;
using espalier::scene::Seed;

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
        {"Branch", "P", Tool::branch, "Pick a branch: prune it, freeze its plant, see how it walked"},
        {"Roofs", "H", Tool::houses, "Choose a house: its roof, its outline"}};
    const float pad = 2 * work.scale, gap = ImGui::GetStyle().ItemSpacing.x / 2;
    ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, {pad, ImGui::GetStyle().FramePadding.y});
    ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, {gap, ImGui::GetStyle().ItemSpacing.y});
    // Only scenes with a town have roofs.
    const std::span shown(entries, std::size(entries) - (espHouseCount(work.context.get()) ? 0 : 1));
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

void limits(const Workspace& work, Brush& brush) {
    checkBox("Only some slopes and heights", &brush.limited);
    toolTip(
        "Paint fades out where the surface is steeper or flatter, higher or lower: there it is hatched\nwhile the "
        "layer is "
        "shown (V). The numbers beside the brush say what slope and height are there");
    if (!brush.limited) return;
    rowLabel("Slope");
    keepingDrag("##slope", brush.slope, [&] {
        return ImGui::DragFloatRange2("##slope", &brush.slope[0], &brush.slope[1], 1, 0, 180, "%.0f\u00b0",
                                      "%.0f\u00b0", ImGuiSliderFlags_AlwaysClamp);
    });
    toolTip("0\u00b0: floors, 90\u00b0: walls, 180\u00b0: ceilings");
    // Beyond the scene there is nothing to limit.
    const auto [low, high] = work.bounds();
    const float least = std::floor(low.y), most = std::ceil(high.y);
    rowLabel("Height");
    keepingDrag("##height", brush.height, [&] {
        float shown[2] = {std::clamp(brush.height[0], least, most), std::clamp(brush.height[1], least, most)};
        if (!ImGui::DragFloatRange2("##height", &shown[0], &shown[1], .01f, least, most,
                                    shown[0] <= least ? "any" : "%.1f m", shown[1] >= most ? "any" : "%.1f m",
                                    ImGuiSliderFlags_AlwaysClamp))
            return false;
        brush.height[0] = shown[0] <= least ? -1e6f : shown[0];
        brush.height[1] = shown[1] >= most ? 1e6f : shown[1];
        return true;
    });
    toolTip("From the lowest to the highest point that takes paint: drag, or double click to type");
    labelledSlider("Softness", &brush.softness, 0, 1, "%.2f");
    toolTip("0: the limits are edges, 1: paint fades out over a wide band");
}

// Values that the chosen seeds have in place of their grammar's.
void ownValues(Workspace& work, std::vector<SeedRecord> chosen) {
    if (!ImGui::TreeNode("Values of their own")) return;
    ImGui::PushID(int(chosen[0].key));  // what is typed is theirs
    std::erase_if(chosen, [grammar = chosen[0].grammar](const SeedRecord& seed) { return seed.grammar != grammar; });
    const EspGrammar grammar = work.scene().grammars[chosen[0].grammar].id;
    for (uint32_t i = 0; i < espParamCount(work.context.get(), grammar); ++i) {
        EspParamInfo info;
        if (espParamInfo(work.context.get(), grammar, i, &info) != ESP_OK) continue;
        using Value = std::array<float, 3>;
        const size_t count = info.kind == ESP_PARAM_COLOUR ? 3 : 1;
        const auto valueOf = [&](const float* from) {
            Value value{};
            std::copy_n(from, count, value.begin());
            return value;
        };
        const auto named = [&](const Param& param) { return param.name == info.name; };
        std::vector<Value> own;  // of those that have one
        for (const SeedRecord& seed : chosen)
            if (const auto param = std::ranges::find_if(seed.params, named);
                param != seed.params.end() && param->value.size() == count)
                own.push_back(valueOf(param->value.data()));
        bool has = !own.empty();
        Value value = has ? own[0] : valueOf(info.value);
        const bool several = std::ranges::any_of(own, [&](const Value& other) { return other != value; });
        const bool some = has && own.size() < chosen.size();
        ImGui::PushID(info.name);
        ImGui::PushItemFlag(ImGuiItemFlags_MixedValue, some);
        bool changed = checkBox(info.label, &has);
        ImGui::PopItemFlag();
        toolTip("A value of their own in place of the grammar's");
        has = has || some;  // those that had none get it, too
        uint32_t gesture = 0;
        if (has && !changed) {
            info.label = "On";
            ImGui::SetNextItemWidth(-1);
            changed = editParam(info, value.data(), several);
            gesture = changed ? widgetGesture(work) : 0;
        }
        ImGui::PopID();
        if (!changed) continue;
        for (SeedRecord& seed : chosen) {
            std::erase_if(seed.params, named);
            if (has) seed.params.push_back({info.name, {value.begin(), value.begin() + count}});
        }
        work.changeSeeds({chosen}, gesture);
    }
    ImGui::PopID();
    ImGui::TreePop();
}

// One row of a seed's numbers for all that are chosen.
void chosenSeeds(Workspace& work) {
    std::vector<SeedRecord> chosen;
    for (const Seed& seed : work.scene().seeds)
        if (work.selected.count(seed.key)) chosen.push_back(work.document->recordOf(seed));
    if (chosen.empty()) {
        ImGui::TextDisabled("No seed is chosen");
        return;
    }
    if (chosen.size() == 1)
        ImGui::Text("Seed at %.2f, %.2f, %.2f", chosen[0].position[0], chosen[0].position[1], chosen[0].position[2]);
    else
        ImGui::Text("%zu seeds chosen", chosen.size());
    // Growth is read back for it: not while a seed is on its way, nor before it has grown.
    const bool settled = !work.underWay && work.grownRevision == work.document->revision();
    if (chosen.size() == 1 && settled && !ImGui::IsMouseDown(0) && work.barren(chosen[0].key))
        hint(work.scene().layers.empty()
                 ? "Nothing grows from it."
                 : "Nothing grows from it: it may be that a layer is empty here. B shows what is painted.");
    uint32_t gesture = 0;  // of what has changed; 0: nothing has
    int64_t number = chosen[0].number;
    rowLabel("Random no.");
    const float another = ImGui::CalcTextSize("Another").x + 2 * ImGui::GetStyle().FramePadding.x;
    ImGui::SetNextItemWidth(ImGui::GetContentRegionAvail().x - another - ImGui::GetStyle().ItemSpacing.x);
    const bool several = std::ranges::any_of(chosen, [&](const SeedRecord& seed) { return seed.number != number; });
    ImGui::PushID(int(chosen[0].key));
    const bool typed =
        ImGui::InputScalar("##number", ImGuiDataType_S64, &number, nullptr, nullptr, several ? "%lld \u2026" : "%lld");
    const bool escaped = ImGui::IsItemDeactivated() && ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_Escape), false);
    if (escaped) {
        work.takeBack(work.gesture());
    } else if (typed) {
        number = std::clamp<int64_t>(number, 0, std::numeric_limits<uint32_t>::max());
        for (SeedRecord& seed : chosen) seed.number = uint32_t(number++);
        gesture = widgetGesture(work);
    }
    ImGui::PopID();
    toolTip(chosen.size() == 1 ? "Its random number: another one grows another plant"
                               : "Typed: the first one's random number, the others get those that follow it");
    ImGui::SameLine();
    if (ImGui::Button("Another", {-1, 0})) {
        for (SeedRecord& seed : chosen) seed.number = seed.number * 747796405u + 2891336453u;
        gesture = work.newGesture();
    }
    toolTip("Another random number: another plant from the same seed");
    if (work.scene().grammars.size() > 1) {
        const uint32_t now = chosen[0].grammar;
        rowLabel("Grammar");
        if (beginCombo("##grammar", grammarName(work.scene(), now))) {
            for (uint32_t i = 0; i < work.scene().grammars.size(); ++i)
                if (ImGui::Selectable(grammarName(work.scene(), i).c_str(), i == now)) {
                    for (SeedRecord& seed : chosen) seed.grammar = i;
                    gesture = work.newGesture();
                }
            ImGui::EndCombo();
        }
        toolTip("What grows from the chosen seeds");
    }
    if (gesture) work.changeSeeds({chosen}, gesture);
    ownValues(work, chosen);
    std::vector<uint32_t> growing, frozen;
    for (const SeedRecord& seed : chosen) (seed.frozen ? frozen : growing).push_back(seed.key);
    if (!growing.empty()) {
        if (ImGui::Button("Freeze", {-1, 0})) work.freeze(growing, true);
        toolTip("The plant stands as it is: neither paint nor sliders change it any more");
    }
    if (!frozen.empty()) {
        if (ImGui::Button("Thaw", {-1, 0})) work.freeze(frozen, false);
        toolTip("The plant grows again from what is there");
    }
    if (ImGui::Button("Remove  Del", {-1, 0})) {
        RemoveSeeds remove;
        for (const SeedRecord& seed : chosen) remove.keys.push_back(seed.key);
        work.perform(remove);
    }
    toolTip("The chosen seeds go, with what grew from them");
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
        case ESP_VIEW_LAYER:
            break;
    }
    return "Layer";
}

void brushPanel(Workspace& work) {
    Brush& b = work.brush;
    const float third = (ImGui::GetContentRegionAvail().x - 2 * ImGui::GetStyle().ItemSpacing.x) / 3;
    const auto mode = [&](const char* label, const char* name, const char* tip) {
        if (chosenButton(label, b.mode == name, {third, 0})) b.mode = name;
        toolTip(tip);
    };
    ImGui::PushID("mode");
    mode("Paint", "paint", "Towards the value or colour below");
    ImGui::SameLine();
    mode("Erase", "erase",
         "Back to as it comes: what all of the layer was cleared or filled to, or else what the grammar says, as the "
         "line "
         "at the bottom tells. Also with Ctrl, which paints while this is chosen. To take away what grows, paint the "
         "opposite value (X)");
    ImGui::SameLine();
    mode("Smooth", "smooth", "Towards what is around; also with Shift");
    ImGui::PopID();
    labelledSlider("Radius", &work.brushRadius(), .01f, 20, "%.2f m", true);
    toolTip("[ and ], or F and a move of the mouse");
    labelledSlider("Strength", &b.strength, .01f, 1, "%.2f");
    toolTip("How much one dab changes, or Shift+F and a move of the mouse");
    labelledSlider("Hardness", &b.hardness, 0, 1, "%.2f");
    toolTip("0: soft from the centre, 1: a hard edge");
    if (isColour(work.scene(), b.layer)) {
        rowLabel("Colour");
        editColour("##colour", b.colour);
        toolTip("What is painted; the field at the end opens a picker");
    } else {
        labelledSlider("Value", &b.value, 0, 1, "%.2f");
        toolTip("What is painted; what 0 and 1 mean is said where the layer is chosen. X: the opposite");
    }
    labelledSlider("Spacing", &b.spacing, .05f, 1, "%.2f");
    toolTip("Between two dabs, of the radius");
    if (work.townLayer(b.layer)) return;
    limits(work, b);
    checkBox("Only what faces as the centre does", &b.frontOnly);
    toolTip("A brush on a thin wall leaves its back alone");
}

void seedsPanel(Workspace& work) {
    const auto& scene = work.scene();
    if (scene.grammars.size() > 1) {
        rowLabel("Plant");
        if (beginCombo("##plant", grammarName(scene, work.plantGrammar))) {
            for (uint32_t i = 0; i < scene.grammars.size(); ++i)
                if (ImGui::Selectable(grammarName(scene, i).c_str(), i == work.plantGrammar)) work.plantGrammar = i;
            ImGui::EndCombo();
        }
        toolTip("What grows from the next seeds");
    }
    chosenSeeds(work);
    labelledSlider("Row's step", &work.layout.rowStep, kLeastRowStep, kMostRowStep, "%.2f m", true);
    toolTip("Between two seeds of a row: Ctrl and a drag plant one");
    checkBox("A row's seeds look along it", &work.layout.rowAlong);
    toolTip("Else they look upward");
    const float half = (ImGui::GetContentRegionAvail().x - ImGui::GetStyle().ItemSpacing.x) / 2;
    ImGui::BeginDisabled(scene.seeds.empty());
    if (ImGui::Button("Reseed all", {half, 0})) work.renumberSeeds();
    toolTip("Other random numbers for all seeds  (Shift+R)");
    ImGui::SameLine();
    if (ImGui::Button("Remove all", {half, 0})) {
        RemoveSeeds all;
        for (const Seed& seed : scene.seeds) all.keys.push_back(seed.key);
        work.perform(all);
    }
    toolTip("All seeds of the scene go; Ctrl+Z brings them back");
    ImGui::EndDisabled();
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
        ImGui::EndCombo();
    }
    toolTip("What is shown of the scene  (1 to 6)");
    if (layer) {
        if (labelledSlider("Opacity", &work.layout.layerOpacity, .05f, 1, "%.2f")) work.redraw = true;
        toolTip("Of the painted layer over the model");
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
        if (std::exchange(shown, work.tool) != work.tool) ImGui::SetScrollY(0);  // what it has stands first
        toolButtons(work);
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
        if (work.tool == Tool::seeds) seedsPanel(work);
        if (work.tool == Tool::branch) branchPanel(work);
        if (work.tool == Tool::houses) housesPanel(work);
        ImGui::Spacing();
        grammarsPanel(work);
        if (work.tool != Tool::paint && ImGui::CollapsingHeader("Layers")) layersPanel(work);
    }
    ImGui::End();
}

}  // namespace sample
