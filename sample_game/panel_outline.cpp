// What the scene is made of, by names: plants, models and houses, to be chosen, hidden, locked and placed.
#include <imgui.h>

#include <algorithm>

#include "sample_game/panels.hpp"

namespace sample {
namespace {

using namespace espalier::document;

constexpr float kDegree = 3.14159265f / 180;
constexpr float kLeastReach = 10;                  // metres that a slider goes to either side at least
constexpr float kSmallest = .01f, kLargest = 100;  // of its own size

// Names of one file are told apart by their places.
std::string nameOf(const Workspace& work, size_t index) {
    const auto& surfaces = work.scene().surfaces;
    const auto upTo = surfaces.begin() + std::ptrdiff_t(index);
    const auto before =
        std::count_if(surfaces.begin(), upTo, [&](const auto& s) { return s.file == surfaces[index].file; });
    std::string name = espalier::scene::lastPart(surfaces[index].file);
    if (const size_t ending = name.find(".surface.glb"); ending != std::string::npos) name.resize(ending);
    return before > 0 ? name + " (" + std::to_string(before + 1) + ")" : name;
}

// Of a row's pictures, which stand close.
void sameLine() {
    ImGui::SameLine(0, ImGui::GetStyle().ItemInnerSpacing.x / 2);
}

void placePanel(Workspace& work, uint32_t index) {
    const espalier::scene::Placing& now = work.scene().surfaces[index].placing;
    PlaceSurface place{index, now.position, now.turn, now.scale, now.mirror};
    const float reach = std::max(kLeastReach, 2 * work.reach());
    const char* const axes[] = {"Right", "Up", "Front"};
    bool changed = false;
    uint32_t gesture = 0;
    const auto slid = [&](bool moved) {
        if (moved) gesture = widgetGesture(work), changed = true;
    };
    for (size_t i = 0; i < 3; ++i)
        slid(labelledSlider(axes[i], &place.position[i], std::min(-reach, now.position[i]),
                            std::max(reach, now.position[i]), "%.2f m"));
    float degrees = place.turn / kDegree;
    const float before = degrees;
    slid(labelledSlider("Turn", &degrees, std::min(-180.f, before), std::max(180.f, before), "%.0f\u00b0"));
    if (degrees != before) place.turn = degrees * kDegree;
    slid(labelledSlider("Size", &place.scale, std::min(kSmallest, now.scale), std::max(kLargest, now.scale), "%.3g",
                        true));
    toolTip("Times the size in the model's file");
    if (ImGui::Checkbox("Mirrored", &place.mirror)) gesture = work.newGesture(), changed = true;
    toolTip("Left becomes right: a second look for the same model");
    if (changed) work.perform(place, gesture);
}

}  // namespace

// A click chooses a plant, a second one shows it.
void plantsPanel(Workspace& work) {
    constexpr int kRows = 8;
    const auto& seeds = work.scene().seeds;
    const float line = ImGui::GetFrameHeightWithSpacing();
    ImGui::BeginChild("plants", {0, line * float(std::min<size_t>(seeds.size(), kRows)) + line / 2}, true, kQuiet);
    ImGuiListClipper clipper;
    clipper.Begin(int(seeds.size()), line);
    while (clipper.Step())
        for (int i = clipper.DisplayStart; i < clipper.DisplayEnd && size_t(i) < seeds.size(); ++i) {
            const espalier::scene::Seed& seed = seeds[size_t(i)];
            const uint32_t key = seed.key;
            ImGui::PushID(int(key));
            bool locked = seed.frozen != nullptr, shown = !seed.hidden;
            const std::string name = grammarName(work.scene(), seed.grammar) + " " + std::to_string(i + 1);
            if (eyeBox("##shown", &shown)) {
                if (ImGui::GetIO().KeyAlt)
                    work.isolate({{key}, {}, {}});
                else
                    work.perform(ShowPlants{{key}, shown});
            }
            toolTip("Shown or hidden. Alt+click: this plant alone, or all again");
            sameLine();
            if (lockBox("##locked", &locked)) work.freeze({key}, locked);
            toolTip("Locked: neither paint nor sliders change the plant");
            sameLine();
            ImGui::AlignTextToFramePadding();
            if (ImGui::Selectable(name.c_str(), work.selected.contains(key), ImGuiSelectableFlags_AllowDoubleClick)) {
                work.selected = {key};
                work.choose(Tool::seeds);
                if (ImGui::IsMouseDoubleClicked(0)) work.frameChosen(), work.looked = true;
            }
            toolTip("Click: choose it; double click: show it");
            ImGui::PopID();
        }
    ImGui::EndChild();
}

void modelsPanel(Workspace& work) {
    for (uint32_t i = 0; i < work.scene().surfaces.size(); ++i) {
        const espalier::scene::LoadedSurface& surface = work.scene().surfaces[i];
        bool shown = !surface.hidden, locked = surface.locked;
        ImGui::PushID(int(i));
        if (eyeBox("##shown", &shown)) {
            if (ImGui::GetIO().KeyAlt)
                work.isolate({{}, {i}, {}});
            else
                work.perform(ShowSurfaces{{i}, shown});
        }
        toolTip("Shown or hidden; it stays ground. Alt+click: this model alone, or all again");
        sameLine();
        if (lockBox("##locked", &locked)) work.perform(LockSurface{i, locked});
        toolTip("Locked: it stays where it is");
        sameLine();
        const bool open = ImGui::TreeNode("model", "%s", nameOf(work, i).c_str());
        toolTip(work.scene().surfaces[i].file.c_str());
        if (open) {
            ImGui::BeginDisabled(work.scene().surfaces[i].locked);
            placePanel(work, i);
            ImGui::EndDisabled();
            ImGui::TreePop();
        }
        ImGui::PopID();
    }
}

// By the names that their plan gives.
void houseList(Workspace& work) {
    constexpr uint32_t kRows = 8;
    if (!work.scene().town) return;
    const uint32_t count = espHouseCount(work.context.get());
    const float line = ImGui::GetFrameHeightWithSpacing();
    ImGui::BeginChild("houses", {0, line * float(std::min(count, kRows)) + line / 2}, true, kQuiet);
    ImGuiListClipper clipper;
    clipper.Begin(int(count), line);
    while (clipper.Step())
        for (int i = clipper.DisplayStart; i < clipper.DisplayEnd; ++i) {
            EspHouseInfo info;
            const bool named = espHouseInfo(work.context.get(), uint32_t(i), &info) == ESP_OK && info.id[0];
            const std::string name = "House " + (named ? std::string(info.id) : std::to_string(i + 1));
            ImGui::PushID(i);
            const espalier::scene::HouseMark mark = work.scene().town->mark(uint32_t(i));
            bool shown = !mark.hidden, locked = mark.locked;
            if (eyeBox("##shown", &shown)) {
                if (ImGui::GetIO().KeyAlt)
                    work.isolate({{}, {}, {uint32_t(i)}});
                else
                    work.perform(ShowHouses{{uint32_t(i)}, shown});
            }
            toolTip("Shown or hidden. Alt+click: this house alone, or all again");
            sameLine();
            if (lockBox("##locked", &locked)) work.perform(LockHouse{uint32_t(i), locked});
            toolTip("Locked: it stays as it is");
            sameLine();
            ImGui::AlignTextToFramePadding();
            if (ImGui::Selectable(name.c_str(), work.house == uint32_t(i), ImGuiSelectableFlags_AllowDoubleClick)) {
                work.choose(Tool::houses);
                work.house = uint32_t(i);
                work.houseEdge.reset();
                if (ImGui::IsMouseDoubleClicked(0)) work.frameChosen(), work.looked = true;
            }
            toolTip("Click: choose it; double click: show it");
            ImGui::PopID();
        }
    ImGui::EndChild();
}

}  // namespace sample
