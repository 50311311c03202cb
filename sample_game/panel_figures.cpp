// Counts, memory and the time of each stage, over the picture at the right.
#include <imgui.h>
#include <imgui_internal.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "sample_game/brush_tool.hpp"
#include "sample_game/panels.hpp"
#include "tools/scene/layers.hpp"

namespace sample {
namespace {

std::string grouped(uint64_t value) {
    std::string text = std::to_string(value);
    for (int at = int(text.size()) - 3; at > 0; at -= 3) text.insert(size_t(at), ",");
    return text;
}

std::string ms(double value) {
    if (value == 0) return "-";  // it hasn't run, or isn't told before the next one does
    char text[32];
    std::snprintf(text, sizeof text, value < 10 ? "%.2f ms" : "%.0f ms", value);
    return text;
}

// A window over the picture that takes no mouse: what lies behind it is clicked, dragged and painted as if it weren't
// there, and seen through it while a tool is near. at: its corner that `pivot` says; width 0: as it needs.
bool beginOverlay(const Workspace& work, const char* name, ImVec2 at, ImVec2 pivot, float width) {
    constexpr float kFaint = .2f, kNear = 24;
    const ImGuiWindow* before = ImGui::FindWindowByName(name);
    ImRect around = before ? before->Rect() : ImRect();
    around.Expand(kNear * work.scale);
    const bool reached = work.tool != Tool::look && around.Contains(ImGui::GetIO().MousePos);
    const float alpha = reached ? kFaint : 1;
    ImGui::PushStyleVar(ImGuiStyleVar_Alpha, alpha);
    ImGui::SetNextWindowPos(at, ImGuiCond_Always, pivot);
    if (width > 0) ImGui::SetNextWindowSize({width, 0});
    ImGui::SetNextWindowBgAlpha(.72f * alpha);
    const ImGuiWindowFlags flags = ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoInputs |
                                   ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoFocusOnAppearing |
                                   ImGuiWindowFlags_NoBringToFrontOnFocus | ImGuiWindowFlags_AlwaysAutoResize;
    return ImGui::Begin(name, nullptr, flags);
}

void endOverlay() {
    ImGui::End();
    ImGui::PopStyleVar();
}

// A colour of our own, as faint as ImGui's are now.
ImU32 faded(ImU32 colour) {
    return ImGui::GetColorU32(colour);
}

constexpr const char* kStages[] = {"Expand", "Emit", "Draw"};
constexpr ImU32 kColours[] = {IM_COL32(120, 200, 90, 255), IM_COL32(90, 160, 230, 255), IM_COL32(230, 160, 70, 255)};

// Stages stacked, one column a picture, the latest at the right.
void graph(const Workspace& work) {
    const float s = work.scale, height = 56 * s, width = ImGui::GetContentRegionAvail().x;
    const ImVec2 at = ImGui::GetCursorScreenPos();
    ImDrawList& list = *ImGui::GetWindowDrawList();
    list.AddRectFilled(at, {at.x + width, at.y + height}, faded(IM_COL32(0, 0, 0, 90)));
    const float column = 2 * s;
    const size_t shown = std::min(work.history.size(), size_t(width / column));
    std::vector<float> sums;
    for (size_t i = work.history.size() - shown; i < work.history.size(); ++i)
        if (const auto& f = work.history[i]; f[0] + f[1] + f[2] > 0) sums.push_back(f[0] + f[1] + f[2]);
    std::sort(sums.begin(), sums.end());
    // The first frame, which makes programs, would flatten all others: it is cut off at the top.
    const float highest = sums.empty() ? 20 : std::max(20.f, std::min(sums.back(), 4 * sums[sums.size() / 2]));
    for (size_t i = 0; i < shown; ++i) {
        const auto& frame = work.history[work.history.size() - shown + i];
        const float x = at.x + width - column * float(shown - i);
        float y = at.y + height;
        for (int stage = 0; stage < 3; ++stage) {
            const float top = std::max(y - height * frame[stage] / highest, at.y);
            if (y - top > .3f) list.AddRectFilled({x, top}, {x + column - 1, y}, faded(kColours[stage]));
            y = top;
        }
    }
    const std::string top = ms(highest);
    const ImVec2 size = ImGui::CalcTextSize(top.c_str());
    list.AddRectFilled(at, {at.x + size.x + 8, at.y + size.y + 4}, faded(IM_COL32(0, 0, 0, 170)));
    list.AddText({at.x + 4, at.y + 2}, ImGui::GetColorU32(ImGuiCol_TextDisabled), top.c_str());
    ImGui::Dummy({width, height});
}

// Stripes as the model has them, and what they mean.
void hatchedRow(float scale) {
    const float side = ImGui::GetFontSize(), step = side / 2.5f;
    const ImVec2 at = ImGui::GetCursorScreenPos(), end{at.x + 2 * side, at.y + side};
    ImDrawList& list = *ImGui::GetWindowDrawList();
    list.AddRectFilled(at, end, faded(IM_COL32(80, 85, 97, 255)));
    list.PushClipRect(at, end, true);
    for (float x = 0; x < 3 * side; x += step)
        list.AddLine({at.x + x, at.y}, {at.x + x - side, end.y}, faded(IM_COL32(15, 16, 18, 255)), 2.5f * scale);
    list.PopClipRect();
    ImGui::Dummy({2 * side, side});
    ImGui::SameLine();
    ImGui::TextUnformatted("beyond the limits");
}

}  // namespace

void showFigures(const Workspace& work, uint32_t validationMessages, bool validation) {
    if (!work.layout.figures) return;
    // Where letters are large and the window isn't, the scene comes first.
    const float s = work.scale, margin = 12 * s, room = work.window.x - work.panelUnits() - 2 * margin;
    const bool brief = room < 3 * 235 * s - 2 * margin, narrow = room < 235 * s;
    if (room < 120 * s) return;
    if (beginOverlay(work, "figures", {work.window.x - margin, margin + ImGui::GetFrameHeight()}, {1, 0},
                     std::min(235 * s, room))) {
        const auto row = [](const char* name, const std::string& value, ImU32 colour = 0) {
            if (colour) {
                const ImVec2 at = ImGui::GetCursorScreenPos();
                const float size = ImGui::GetFontSize() * .6f, down = ImGui::GetFontSize() * .25f;
                ImGui::GetWindowDrawList()->AddRectFilled({at.x, at.y + down}, {at.x + size, at.y + down + size},
                                                          faded(colour));
                ImGui::SetCursorPosX(ImGui::GetCursorPosX() + size * 1.6f);
            }
            ImGui::TextDisabled("%s", name);
            ImGui::SameLine();
            ImGui::SetCursorPosX(ImGui::GetWindowContentRegionMax().x - ImGui::CalcTextSize(value.c_str()).x);
            ImGui::TextUnformatted(value.c_str());
        };
        ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, {8 * s, 2 * s});
        const EspStats& stats = work.stats;
        const EspRoofStats& roofs = work.roofs;
        const bool plants = stats.seeds || !roofs.houses;
        if (!brief && plants) row("Seeds", grouped(stats.seeds));
        if (!brief && plants) row("Branches", grouped(stats.branches));
        if (plants) row("Nodes", grouped(stats.nodes));
        if (plants) row("Leaves", grouped(stats.leaves));
        if (!brief && plants) row("Plants' triangles", grouped(stats.drawnPolygons));
        if (!brief && plants) row("at full detail", grouped(stats.polygons));
        if (roofs.houses) row("Houses", grouped(roofs.houses));
        if (!narrow && roofs.houses) row("Tiles and parts", grouped(roofs.tiles));
        if (!brief && roofs.houses) row("Houses' triangles", grouped(roofs.drawnTriangles));
        ImGui::Spacing();
        const double times[] = {work.grownMs, stats.emitMs, stats.drawMs};
        for (int i = 0; i < 3 && !brief; ++i) row(kStages[i], ms(times[i]), kColours[i]);
        row("Frame", ms(work.pictureMs));
        if (!brief) graph(work);
        if (!brief) row("Times grown", grouped(stats.expansions));
        // In use, of what is taken from the device.
        const std::string taken = narrow ? "" : " of " + grouped(stats.reservedBytes >> 20);
        row(narrow ? "Memory" : "GPU memory", grouped(stats.totalBytes >> 20) + taken + " MiB");
        if (!brief)
            row("Undo", grouped(work.document->undoSteps()) + (work.document->undoSteps() == 1 ? " step" : " steps"));
        if (stats.overflow) row("Ran out of room", grouped(stats.overflow));
        if (stats.stopped) row("Stopped by a limit", grouped(stats.stopped));
        if (roofs.overflow) row("Tiles left out", grouped(roofs.overflow));
        if (roofs.stopped) row("Roofs' parts stopped", grouped(roofs.stopped));
        if (validation) row("Validation messages", grouped(validationMessages));
        ImGui::PopStyleVar();
    }
    endOverlay();
}

namespace {

// What the layer's grammar calls some of its values.
void namedRows(const Workspace& work, const std::string& layer) {
    const float side = ImGui::GetFontSize();
    const std::string label = espalier::scene::labelOf(work.context.get(), work.scene(), layer);
    for (const auto& named : espalier::scene::labelWords(label).values) {
        const ImVec2 at = ImGui::GetCursorScreenPos();
        ImGui::GetWindowDrawList()->AddRectFilled(at, {at.x + side, at.y + side},
                                                  faded(viewColour(ESP_VIEW_LAYER, named.value)));
        ImGui::Dummy({side, side});
        ImGui::SameLine();
        ImGui::TextUnformatted(named.name.c_str());
    }
}

// The directions that the view of normals has colours for, as pairs of opposites.
void normalsLegend() {
    ImGui::TextUnformatted("Which way surfaces face");
    constexpr struct {
        const char* name;
        float normal[3];
    } kFaces[] = {{"east", {1, 0, 0}},  {"west", {-1, 0, 0}}, {"up", {0, 1, 0}},
                  {"down", {0, -1, 0}}, {"south", {0, 0, 1}}, {"north", {0, 0, -1}}};
    const float side = ImGui::GetFontSize();
    for (const auto& face : kFaces) {
        const float* n = face.normal;
        const float rgb[3] = {n[0] * .5f + .5f, n[1] * .5f + .5f, n[2] * .5f + .5f};
        if ((&face - kFaces) % 2) ImGui::SameLine(6 * side);
        const ImVec2 at = ImGui::GetCursorScreenPos();
        ImGui::GetWindowDrawList()->AddRectFilled(at, {at.x + side, at.y + side}, faded(shownColour(rgb)));
        ImGui::Dummy({side, side});
        ImGui::SameLine();
        ImGui::TextUnformatted(face.name);
    }
}

// From nothing to as much as the view tells apart, with what it is about above.
void legendOf(const Workspace& work, EspView view, float most) {
    const float s = work.scale;
    const bool layer = view == ESP_VIEW_LAYER, levels = view == ESP_VIEW_LOD;
    const float room = work.window.x - work.panelUnits() - 24 * s - 2 * ImGui::GetStyle().WindowPadding.x;
    const float width = std::min((layer ? 120 : 260) * s, room), height = ImGui::GetFontSize();
    ImGui::PushTextWrapPos(ImGui::GetCursorPosX() + std::min(260 * s, room));
    ImGui::TextUnformatted(layer                    ? work.scene().viewLayer.c_str()
                           : levels                 ? "Level of detail: 0 is the model itself"
                           : view == ESP_VIEW_DEPTH ? "Branches between a stem and its seed"
                                                    : "Fragments shaded for a pixel");
    ImGui::PopTextWrapPos();
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const float steps = levels ? most + 1 : 64;
    for (float i = 0; i < steps; ++i) {
        ImGui::GetWindowDrawList()->AddRectFilled({at.x + width * i / steps, at.y},
                                                  {at.x + width * (i + 1) / steps, at.y + height},
                                                  faded(viewColour(view, levels ? i : most * (i + .5f) / steps)));
    }
    ImGui::Dummy({width, height});
    ImGui::TextDisabled("0");
    const std::string last = std::to_string(int(most)) + (layer ? "" : " and more");
    ImGui::SameLine(ImGui::GetCursorPosX() + width - ImGui::CalcTextSize(last.c_str()).x);
    ImGui::TextDisabled("%s", last.c_str());
    if (layer) namedRows(work, work.scene().viewLayer);
    if (limitingStroke(work)) hatchedRow(s);
}

}  // namespace

void showLegend(const Workspace& work) {
    const EspView view = work.scene().look.view;
    float rgb[3], most = 0;
    const bool colours = view == ESP_VIEW_LAYER && isColour(work.scene(), work.scene().viewLayer);
    const bool amounts = espViewColour(view, 0, rgb, &most) == ESP_OK;
    if (colours || (!amounts && view != ESP_VIEW_CHARTS && view != ESP_VIEW_NORMALS)) return;
    const float s = work.scale;
    const ImVec2 corner{work.panelUnits() + 12 * s, work.viewSize().y - ImGui::GetFrameHeight() - 16 * s};
    if (beginOverlay(work, "legend", corner, {0, 1}, 0)) {
        if (view == ESP_VIEW_CHARTS)
            ImGui::TextUnformatted("A colour for each chart\nPale: links lead over its border");
        else if (view == ESP_VIEW_NORMALS)
            normalsLegend();
        else
            legendOf(work, view, most);
    }
    endOverlay();
}

}  // namespace sample
