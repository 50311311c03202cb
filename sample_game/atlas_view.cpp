// The window around an atlas' picture, and what is drawn over that.
#include "sample_game/atlas_view.hpp"

#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "sample_game/panels.hpp"

namespace sample {
namespace {

constexpr float kLinkReach = 7;  // pixels from the mouse to a link
constexpr const char* kLinkNames[] = {"Seams", "Nearest points", "Contacts", "Open borders"};
constexpr ImU32 kSample = IM_COL32(255, 255, 255, 255), kInserted = IM_COL32(120, 200, 255, 255),
                kJump = IM_COL32(110, 230, 90, 255), kPointed = IM_COL32(255, 240, 150, 255);

void arrow(ImDrawList& list, ImVec2 a, ImVec2 b, ImU32 colour, float scale) {
    list.AddLine(a, b, colour, 1.5f * scale);
    const float x = b.x - a.x, y = b.y - a.y, length = std::sqrt(x * x + y * y);
    if (length < 2) return;
    const float s = 7 * scale / length;
    list.AddTriangleFilled(b, {b.x - s * x - .45f * s * y, b.y - s * y + .45f * s * x},
                           {b.x - s * x + .45f * s * y, b.y - s * y - .45f * s * x}, colour);
}

}  // namespace

struct AtlasView::View {
    ImVec2 corner;
    float side;               // of the window onto the picture, in ImGui's units
    float left, top, extent;  // the part of the UV square in it; v goes down, as in pictures of it
    float scale;
    ImVec2 place(const float uv[2]) const {
        return {corner.x + side * (uv[0] - left) / extent, corner.y + side * (uv[1] - top) / extent};
    }
    std::pair<float, float> uvAt(ImVec2 at) const {
        return {left + (at.x - corner.x) / side * extent, top + (at.y - corner.y) / side * extent};
    }
};

void AtlasView::forget() {
    atlas_.forget();
    wanted_.surface = ~0u;
    wanted_.layer.clear();
    followed_.reset();
    zoom_ = 1;
}

// A branch that was picked, or is there when the window opens, is looked for on its own surface.
void AtlasView::followBranch(const Workspace& work) {
    if (!work.branch) followed_.reset();
    if (!work.branch || work.path.empty() || followed_ == work.branch) return;
    followed_ = work.branch;
    const auto& surfaces = work.scene().surfaces;
    const auto lies = [&](size_t surface) {
        return std::ranges::any_of(work.path,
                                   [&](const EspPathSample& s) { return s.surface.id == surfaces[surface].id.id; });
    };
    if (lies(wanted_.surface)) return;
    for (size_t i = 0; i < surfaces.size(); ++i)
        if (surfaces[i].id.id == work.path.front().surface.id) wanted_.surface = uint32_t(i);
}

void AtlasView::surfaceChoice(const Workspace& work) {
    const auto& surfaces = work.scene().surfaces;
    ImGui::SetNextItemWidth(ImGui::GetFontSize() * 9);
    if (beginCombo("##surface", surfaceName(surfaces, wanted_.surface))) {
        for (size_t i = 0; i < surfaces.size(); ++i)
            if (ImGui::Selectable(surfaceName(surfaces, i).c_str(), i == wanted_.surface))
                wanted_.surface = uint32_t(i);
        ImGui::EndCombo();
    }
    toolTip("Which of the scene's surfaces");
    sameLineIfRoom(ImGui::GetFontSize() * 7);
}

void AtlasView::controls(Workspace& work) {
    const auto& scene = work.scene();
    const float room = ImGui::GetFontSize();
    if (scene.surfaces.size() > 1) surfaceChoice(work);
    EspSurfaceInfo info{};
    (void)espSurfaceInfo(work.context.get(), scene.surfaces[wanted_.surface].id, &info);
    wanted_.level = std::min(wanted_.level, std::max(info.levels, 1u) - 1);
    float level = float(wanted_.level);
    keepingDrag("##level", {&level, 1}, [&] {
        int shown = int(level);
        ImGui::SetNextItemWidth(room * 7);
        const bool moved =
            ImGui::SliderInt("##level", &shown, 0, int(info.levels) - 1, "Level %d", ImGuiSliderFlags_AlwaysClamp);
        level = float(shown);
        return moved;
    });
    wanted_.level = uint32_t(level);
    toolTip("0 is the finest; dark charts are too small to be walked on a coarse one");
    sameLineIfRoom(room * 5);
    ImGui::Checkbox("Charts", &wanted_.charts);
    toolTip("Each chart in a colour of its own");
    sameLineIfRoom(room * 5);
    ImGui::Checkbox("Links", &wanted_.links);
    toolTip("Borders, and at the mouse where they lead");
    sameLineIfRoom(room * 6);
    ImGui::SetNextItemWidth(room * 6);
    if (beginCombo("##layer", wanted_.layer.empty() ? "No layer" : wanted_.layer)) {
        if (ImGui::Selectable("No layer", wanted_.layer.empty())) wanted_.layer.clear();
        for (const std::string& layer : scene.layers)
            if (!work.townLayer(layer) && ImGui::Selectable(layer.c_str(), layer == wanted_.layer))
                wanted_.layer = layer;
        if (espHouseCount(work.context.get())) ImGui::TextDisabled("Layers over roofs lie on no chart");
        ImGui::EndCombo();
    }
    if (!wanted_.layer.empty()) {
        sameLineIfRoom(room * 5);
        ImGui::SetNextItemWidth(room * 5);
        slider("##opacity", &wanted_.opacity, 0, 1, "%.2f");
        toolTip("Opacity of the layer");
    }
    if (wanted_.links)
        for (int kind = 0; kind < 4; ++kind) {
            const bool any = std::ranges::any_of(atlas_.links(), [&](const EspLink& l) { return l.kind == kind; });
            if (!any) continue;
            ImGui::TextColored(ImGui::ColorConvertU32ToFloat4(AtlasPicture::kLinkColours[kind]), "%s",
                               kLinkNames[kind]);
            sameLineIfRoom(room * 12);
        }
    if (atlas_.size())
        ImGui::TextDisabled("%u x %u, %u charts", atlas_.size(), atlas_.size(), info.charts);
    else
        ImGui::TextDisabled("Reading ...");
}

void AtlasView::moveView(const View& view) {
    const ImGuiIO& io = ImGui::GetIO();
    if (ImGui::IsItemHovered() && io.MouseWheel != 0) {
        const auto [u, v] = view.uvAt(io.MousePos);
        const float before = zoom_;
        zoom_ = std::clamp(zoom_ * std::pow(1.25f, io.MouseWheel), 1.f, 64.f);
        // What lies under the mouse stays there.
        centre_[0] = u + (centre_[0] - u) * before / zoom_;
        centre_[1] = v + (centre_[1] - v) * before / zoom_;
    }
    if (ImGui::IsItemActive()) {
        centre_[0] -= io.MouseDelta.x / view.side * view.extent;
        centre_[1] -= io.MouseDelta.y / view.side * view.extent;
    }
    const float half = .5f / zoom_;
    for (float& c : centre_) c = std::clamp(c, half, 1 - half);
}

void AtlasView::drawWalk(const Workspace& work, const View& view) const {
    ImDrawList& list = *ImGui::GetWindowDrawList();
    const uint32_t surface = work.scene().surfaces[wanted_.surface].id.id;
    const auto here = [&](const EspPathSample& s) { return s.surface.id == surface; };
    for (size_t i = 0; i + 1 < work.path.size(); ++i) {
        const EspPathSample &a = work.path[i], &b = work.path[i + 1];
        if (here(a) && here(b) && !work.crossings[i])
            list.AddLine(view.place(a.uv), view.place(b.uv), IM_COL32(255, 255, 255, 150), view.scale);
        else if (here(a) && here(b))
            arrow(list, view.place(a.uv), view.place(b.uv), kJump, view.scale);
        else if (here(a) || here(b))  // to or from another surface
            list.AddCircle(view.place(here(a) ? a.uv : b.uv), 5 * view.scale, kJump, 0, 1.5f * view.scale);
    }
    // Smaller where the whole atlas is seen, so that they stay apart.
    const float size = std::clamp(.5f + .25f * std::log2(zoom_), .5f, 1.f) * view.scale;
    for (const EspPathSample& s : work.path)
        if (here(s))
            list.AddCircleFilled(view.place(s.uv), (s.inserted ? 1.8f : 2.4f) * size, s.inserted ? kInserted : kSample);
    if (work.hit && work.hit->surface.id == surface) {
        const ImVec2 at = view.place(work.hit->uv);
        list.AddCircle(at, 6 * view.scale, kPointed, 0, 1.5f * view.scale);
    }
}

const EspLink* AtlasView::linkAt(const View& view, ImVec2 at) const {
    const EspLink* best = nullptr;
    float nearest = kLinkReach * view.scale;
    for (const EspLink& link : atlas_.links()) {
        const ImVec2 a = view.place(link.a), b = view.place(link.b);
        const float dx = b.x - a.x, dy = b.y - a.y, length2 = dx * dx + dy * dy;
        const float t = length2 > 0 ? std::clamp(((at.x - a.x) * dx + (at.y - a.y) * dy) / length2, 0.f, 1.f) : 0;
        const float d = std::hypot(a.x + t * dx - at.x, a.y + t * dy - at.y);
        if (d < nearest) nearest = d, best = &link;
    }
    return best;
}

void AtlasView::tellAt(const Workspace& work, const View& view) const {
    const ImVec2 at = ImGui::GetIO().MousePos;
    const auto [u, v] = view.uvAt(at);
    const int size = int(atlas_.size()), x = int(u * float(size)), y = int(v * float(size));
    if (x < 0 || y < 0 || x >= size || y >= size) return;
    const uint32_t texel = atlas_.texel(uint32_t(x), uint32_t(y)), kind = texel >> 16 & 3u;
    char text[160] = "";
    int used = std::snprintf(text, sizeof text, "Texel %d, %d", x, y);
    if (kind != ESP_TEXEL_EMPTY)
        used += std::snprintf(text + used, sizeof text - size_t(used), "   chart %u%s", texel & 0xFFFFu,
                              kind == ESP_TEXEL_INNER ? "" : " (gutter)");
    if (!atlas_.shown().layer.empty() && kind == ESP_TEXEL_INNER) {
        used += std::snprintf(text + used, sizeof text - size_t(used), "   %.30s", atlas_.shown().layer.c_str());
        for (const float value : atlas_.layerAt(u, v))
            used += std::snprintf(text + used, sizeof text - size_t(used), " %.2f", value);
    }
    const EspLink* link = atlas_.shown().links ? linkAt(view, at) : nullptr;
    if (!link) return ImGui::SetTooltip("%s", text);
    if (link->kind != ESP_LINK_OPEN) drawLink(view, *link, work.scene().surfaces[wanted_.surface].id);
    ImGui::SetTooltip("%s\n%s", text, leadsTo(work.scene(), wanted_.surface, *link).c_str());
}

// On another surface than `shown` its end is a place of another atlas.
void AtlasView::drawLink(const View& view, const EspLink& link, EspSurface shown) {
    ImDrawList& list = *ImGui::GetWindowDrawList();
    const ImVec2 a = view.place(link.a), b = view.place(link.b);
    list.AddLine(a, b, kPointed, 3 * view.scale);
    if (link.toSurface.id != shown.id) return;
    const ImVec2 toA = view.place(link.toA), toB = view.place(link.toB);
    list.AddLine(toA, toB, kPointed, 3 * view.scale);
    arrow(list, {(a.x + b.x) / 2, (a.y + b.y) / 2}, {(toA.x + toB.x) / 2, (toA.y + toB.y) / 2}, kPointed, view.scale);
}

void AtlasView::show(Workspace& work) {
    if (!work.layout.atlas || work.scene().surfaces.empty()) return followed_.reset();
    const float s = work.scale;
    // The first time beside the panel, large enough to tell a walk's samples apart.
    const float high = std::clamp(work.window.y - 120 * s, 320 * s, 600 * s), wide = std::max(high - 90 * s, 300 * s);
    if (!beginWindow(work, "Atlas", &work.layout.atlas, {work.panelUnits() + 12 * s, 40 * s}, {wide, high},
                     ImGuiWindowFlags_NoScrollbar | ImGuiWindowFlags_NoScrollWithMouse))
        return ImGui::End();
    wanted_.keepTo(work.scene());
    followBranch(work);
    controls(work);
    wanted_.revision = wanted_.layer.empty() ? 0 : work.document->revision();
    if (wanted_ != atlas_.shown()) {
        if (!atlas_.read(work, wanted_)) {
            if (work.error.empty()) work.error = espLastError(work.context.get());
            return ImGui::End();
        }
        if (wanted_.level != work.viewLevel) work.redraw = true;
        work.viewLevel = wanted_.level;
        uint32_t side = 0;
        const std::vector<uint32_t> pixels = atlas_.pixels(side);
        if (!picture_.show(reinterpret_cast<const unsigned char*>(pixels.data()), side, side))
            work.error = picture_.error();
    }
    View view;
    view.corner = ImGui::GetCursorScreenPos();
    view.side = std::max(64.f, std::min(ImGui::GetContentRegionAvail().x, ImGui::GetContentRegionAvail().y));
    view.extent = 1 / zoom_;
    view.left = centre_[0] - .5f * view.extent;
    view.top = centre_[1] - .5f * view.extent;
    view.scale = s;
    const ImVec2 end(view.corner.x + view.side, view.corner.y + view.side);
    ImGui::InvisibleButton("picture", {view.side, view.side},
                           ImGuiButtonFlags_MouseButtonLeft | ImGuiButtonFlags_MouseButtonMiddle);
    const bool over = ImGui::IsItemHovered() && !ImGui::IsItemActive();
    ImGui::GetWindowDrawList()->AddImage(&picture_, view.corner, end, {view.left, view.top},
                                         {view.left + view.extent, view.top + view.extent});
    ImGui::PushClipRect(view.corner, end, true);
    drawWalk(work, view);
    if (over) tellAt(work, view);
    ImGui::PopClipRect();
    moveView(view);
    ImGui::End();
}

}  // namespace sample
