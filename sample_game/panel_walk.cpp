// The walk of a picked branch as in Buron 2015, Figure 4: its samples on the model and in the atlas, an arrow wherever
// it goes over a crossing to another place of the atlas.
#include <imgui.h>

#include <algorithm>
#include <cmath>

#include "sample_game/panels.hpp"

namespace sample {
namespace {

constexpr ImU32 kSample = IM_COL32(255, 255, 255, 255), kInserted = IM_COL32(120, 200, 255, 255),
                kJump = IM_COL32(255, 170, 50, 255);

bool jumps(const EspPathSample& a, const EspPathSample& b) {
    return a.chart != b.chart || a.surface.id != b.surface.id;
}

ImU32 chartColour(uint32_t chart) {
    const ImVec4 colour = ImColor::HSV(float(chart * 2654435761u >> 8) / 16777216.f, .45f, .75f);
    return ImGui::ColorConvertFloat4ToU32(colour);
}

void arrow(ImDrawList& list, ImVec2 a, ImVec2 b, float scale) {
    list.AddLine(a, b, kJump, 1.5f * scale);
    const float x = b.x - a.x, y = b.y - a.y, length = std::sqrt(x * x + y * y);
    if (length < 2) return;
    const float s = 6 * scale / length;
    list.AddTriangleFilled(b, {b.x - s * x - .5f * s * y, b.y - s * y + .5f * s * x},
                           {b.x - s * x + .5f * s * y, b.y - s * y - .5f * s * x}, kJump);
}

// v runs upward.
void atlas(const Workspace& work) {
    const float side = std::max(64.f, std::min(ImGui::GetContentRegionAvail().x, ImGui::GetContentRegionAvail().y));
    const ImVec2 at = ImGui::GetCursorScreenPos();
    ImDrawList& list = *ImGui::GetWindowDrawList();
    const auto place = [&](const EspPathSample& s) {
        return ImVec2(at.x + side * s.uv[0], at.y + side * (1 - s.uv[1]));
    };
    list.AddRectFilled(at, {at.x + side, at.y + side}, IM_COL32(24, 25, 28, 255));
    for (int i = 0; i <= 8; ++i) {
        const float t = side * float(i) / 8;
        list.AddLine({at.x + t, at.y}, {at.x + t, at.y + side}, IM_COL32(60, 62, 66, 255));
        list.AddLine({at.x, at.y + t}, {at.x + side, at.y + t}, IM_COL32(60, 62, 66, 255));
    }
    for (size_t i = 0; i + 1 < work.path.size(); ++i) {
        const EspPathSample &a = work.path[i], &b = work.path[i + 1];
        if (jumps(a, b))
            arrow(list, place(a), place(b), work.scale);
        else
            list.AddLine(place(a), place(b), chartColour(a.chart), 2 * work.scale);
    }
    for (const EspPathSample& s : work.path)
        list.AddCircleFilled(place(s), (s.inserted ? 1.5f : 2) * work.scale, s.inserted ? kInserted : kSample);
    ImGui::Dummy({side, side});
}

}  // namespace

void branchPanel(const Workspace& work) {
    if (!work.branch || work.path.empty()) {
        ImGui::TextDisabled("Click a branch");
        return;
    }
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
    ImGui::SetNextWindowPos({work.window.x - 380 * s, work.window.y - 430 * s}, ImGuiCond_FirstUseEver);
    ImGui::SetNextWindowSize({360 * s, 390 * s}, ImGuiCond_FirstUseEver);
    if (ImGui::Begin("Atlas")) atlas(work);
    ImGui::End();
}

}  // namespace sample
