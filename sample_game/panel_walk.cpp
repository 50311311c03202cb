// The walk of a picked branch on the model: its samples, and where it went over a crossing. AtlasView shows the same in
// the atlas.
#include <imgui.h>

#include <algorithm>
#include <cstdio>

#include "sample_game/panels.hpp"

namespace sample {
namespace {

constexpr ImU32 kSample = IM_COL32(255, 255, 255, 255), kInserted = IM_COL32(120, 200, 255, 255),
                kJump = IM_COL32(110, 230, 90, 255), kPointed = IM_COL32(255, 190, 60, 190),
                kBelow = IM_COL32(20, 24, 16, 170);

// What has been pruned, to take it back.
void prunedRow(Workspace& work) {
    const uint32_t count = espPrunedCount(work.context.get());
    ImGui::AlignTextToFramePadding();
    ImGui::TextDisabled("%u pruned", count);
    toolTip("Prunings that are kept. Some may wait for a branch that isn't there now, as where paint has gone");
    ImGui::SameLine();
    ImGui::BeginDisabled(count == 0);
    if (ImGui::Button("Let all grow again", {-1, 0})) {
        std::vector<uint64_t> keys(count);
        for (uint32_t i = 0; i < count; ++i) (void)espPrunedAt(work.context.get(), i, &keys[i]);
        const uint32_t gesture = work.newGesture();
        for (uint64_t key : keys) {
            char text[20];
            std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(key));
            work.perform(espalier::document::PruneBranch{text, false}, gesture);
        }
        work.document->callStep(gesture, "Let all grow again");
    }
    toolTip("Takes all prunings back, those of branches that aren't there now, too");
    ImGui::EndDisabled();
}

void branchButtons(Workspace& work, bool hasParent) {
    const float half = (ImGui::GetContentRegionAvail().x - ImGui::GetStyle().ItemSpacing.x) / 2;
    ImGui::BeginDisabled(!hasParent);
    if (ImGui::Button("Its parent  [", {half, 0})) work.pickParent();
    toolTip("Picks the branch that this one grows from");
    ImGui::EndDisabled();
    ImGui::SameLine();
    if (ImGui::Button("Atlas  F5", {-1, 0})) work.showAtlas(!work.layout.atlas);
    toolTip("The same walk over the charts of the surface");
}

// seed: of the picked branch; null: none is picked.
void plantButtons(Workspace& work, const espalier::scene::Seed* seed) {
    const float half = (ImGui::GetContentRegionAvail().x - ImGui::GetStyle().ItemSpacing.x) / 2;
    const bool frozen = seed && seed->frozen;
    ImGui::BeginDisabled(!seed || frozen);
    const bool prunes = ImGui::Button("Prune  Del", {half, 0});
    toolTip(frozen ? "A frozen plant stays as it is: thaw it to prune"
                   : "Cuts the branch away with all that grows from it, for good");
    ImGui::EndDisabled();
    ImGui::SameLine();
    ImGui::BeginDisabled(!seed);
    const bool freezes = ImGui::Button(frozen ? "Thaw plant" : "Freeze plant", {-1, 0});
    toolTip("A frozen plant stands as it is: neither paint nor sliders change it");
    ImGui::EndDisabled();
    if (prunes) work.prune();
    if (freezes && seed) work.freeze({seed->key}, !frozen);
}

// Why a branch goes no further, and what may be done about it; by EspBranchEnd.
constexpr struct {
    const char *text, *tip;
} kEndings[] = {{"Ends as its rules say", "It is as long as the grammar and its sliders make it"},
                {"Ends: its condition holds nowhere ahead",
                 "What the grammar asks of a step: what is painted there (B), how steep it is, how far it may be ..."},
                {"Ends: no ground goes on ahead",
                 "The surface ends here, or what is ahead is buried or bare: key 2 shows the ground in colours"},
                {"Ends at a limit of the scene", "The scene's plants may be no more, or no longer"}};

}  // namespace

// All rows are always there, so that nothing moves away from under the mouse.
void branchPanel(Workspace& work) {
    const bool picked = work.branch && !work.path.empty();
    const EspBranchInfo& info = work.branchInfo;
    if (picked) {
        const size_t crossings = size_t(std::ranges::count(work.crossings, true));
        ImGui::Text("Depth %u, %zu samples, %zu crossing%s", info.depth, work.path.size(), crossings,
                    crossings == 1 ? "" : "s");
        char tip[160];
        std::snprintf(tip, sizeof tip,
                      "Branches between it and its seed, steps of its walk,\njumps in the atlas. Its key: %016llx",
                      static_cast<unsigned long long>(*work.branch));
        toolTip(tip);
        ImGui::TextUnformatted(kEndings[info.end].text);
        toolTip(kEndings[info.end].tip);
    } else {
        ImGui::TextDisabled("Click a branch");
        ImGui::TextUnformatted("");
    }
    branchButtons(work, picked && info.depth > 0);
    plantButtons(work, work.branchSeed());
    prunedRow(work);
}

void showWalk(const Workspace& work) {
    ImDrawList& list = *ImGui::GetBackgroundDrawList();
    const float s = work.scale;
    for (size_t i = 0; i + 1 < work.pointed.size(); ++i) {  // what a click would pick
        const auto a = work.place(vec(work.pointed[i].position)), b = work.place(vec(work.pointed[i + 1].position));
        if (a && b) list.AddLine({a->x, a->y}, {b->x, b->y}, kPointed, 5 * s);
    }
    // Dark below, so that white is seen among bright leaves.
    for (const bool below : {true, false})
        for (size_t i = 0; i + 1 < work.path.size(); ++i) {
            const auto a = work.place(vec(work.path[i].position)), b = work.place(vec(work.path[i + 1].position));
            const ImU32 colour = below ? kBelow : work.crossings[i] ? kJump : kSample;
            if (a && b) list.AddLine({a->x, a->y}, {b->x, b->y}, colour, (below ? 7 : 3) * s);
        }
    for (const EspPathSample& sample : work.path)
        if (const auto at = work.place(vec(sample.position))) {
            list.AddCircleFilled({at->x, at->y}, 4.5f * s, kBelow);
            list.AddCircleFilled({at->x, at->y}, 3 * s, sample.inserted ? kInserted : kSample);
        }
}

}  // namespace sample
