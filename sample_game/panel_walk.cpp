// The walk of a picked branch on the model: its samples, and where it went over a crossing. AtlasView shows the same in
// the atlas.
#include <imgui.h>

#include <cstdio>

#include "sample_game/panels.hpp"

namespace sample {
namespace {

constexpr ImU32 kSample = IM_COL32(255, 255, 255, 255), kInserted = IM_COL32(120, 200, 255, 255),
                kJump = IM_COL32(110, 230, 90, 255);

bool jumps(const EspPathSample& a, const EspPathSample& b) {
    return a.chart != b.chart || a.surface.id != b.surface.id;
}

// What has been pruned, to take it back.
void prunedPanel(Workspace& work) {
    const uint32_t count = espPrunedCount(work.context.get());
    if (count == 0) return;
    ImGui::Text("%u pruned", count);
    ImGui::SameLine();
    if (!ImGui::Button("Let all grow again")) return;
    std::vector<uint64_t> keys(count);
    for (uint32_t i = 0; i < count; ++i) (void)espPrunedAt(work.context.get(), i, &keys[i]);
    const uint32_t gesture = work.newGesture();
    for (uint64_t key : keys) {
        char text[20];
        std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(key));
        work.perform(espalier::document::PruneBranch{text, false}, gesture);
    }
}

void plantButtons(Workspace& work) {
    const float half = (ImGui::GetContentRegionAvail().x - ImGui::GetStyle().ItemSpacing.x) / 2;
    if (ImGui::Button("Prune  Del", {half, 0})) return work.prune();
    toolTip("Cuts the branch away with all that grows from it, for good");
    ImGui::SameLine();
    for (const auto& seed : work.scene().seeds) {
        if (seed.planted.id != work.branch->seed.id) continue;
        if (ImGui::Button(seed.frozen ? "Thaw the plant" : "Freeze the plant", {half, 0}))
            work.freeze({seed.key}, !seed.frozen);
        toolTip("A frozen plant stands as it is: neither paint nor sliders change it");
        return;
    }
    ImGui::NewLine();
}

}  // namespace

void branchPanel(Workspace& work) {
    prunedPanel(work);
    if (!work.branch || work.path.empty()) {
        ImGui::TextDisabled("Click a branch");
        return;
    }
    plantButtons(work);
    if (!work.branch) return;
    size_t crossings = 0;
    for (size_t i = 0; i + 1 < work.path.size(); ++i) crossings += jumps(work.path[i], work.path[i + 1]);
    ImGui::Text("Depth %u, %zu samples, %zu crossings", work.branch->depth, work.path.size(), crossings);
    ImGui::TextDisabled("Key %016llx", static_cast<unsigned long long>(work.branch->branch));
}

void showWalk(const Workspace& work) {
    if (work.path.empty()) return;
    ImDrawList& list = *ImGui::GetBackgroundDrawList();
    const float s = work.scale;
    for (size_t i = 0; i + 1 < work.path.size(); ++i) {
        const auto a = work.place(vec(work.path[i].position)), b = work.place(vec(work.path[i + 1].position));
        if (a && b)
            list.AddLine({a->x, a->y}, {b->x, b->y}, jumps(work.path[i], work.path[i + 1]) ? kJump : kSample, 2 * s);
    }
    for (const EspPathSample& sample : work.path)
        if (const auto at = work.place(vec(sample.position)))
            list.AddCircleFilled({at->x, at->y}, 2.5f * s, sample.inserted ? kInserted : kSample);
}

}  // namespace sample
