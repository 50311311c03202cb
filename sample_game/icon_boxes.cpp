// Boxes of a list's row that are pictures: an eye, a lock. Drawn by lines, since not every font has them.
#include <imgui.h>

#include <cmath>

#include "sample_game/widgets.hpp"

namespace sample {
namespace {

// A press in a square of the row's height; its middle and half its side, to draw in.
struct Square {
    ImVec2 middle;
    float half;
    bool pressed, hovered;
};

Square square(const char* id) {
    const float side = ImGui::GetFrameHeight();
    const ImVec2 at = ImGui::GetCursorScreenPos();
    Square out{};
    out.pressed = ImGui::InvisibleButton(id, {side, side});
    out.hovered = ImGui::IsItemHovered();
    out.middle = {at.x + side / 2, at.y + side / 2};
    out.half = side / 2;
    return out;
}

ImU32 inkOf(const Square& box, bool strong) {
    return ImGui::GetColorU32(strong || box.hovered ? ImGuiCol_Text : ImGuiCol_TextDisabled);
}

// Two bows over each other.
void drawEye(const Square& box, bool open) {
    ImDrawList& list = *ImGui::GetWindowDrawList();
    const ImU32 ink = inkOf(box, open);
    const float wide = box.half * .72f, high = box.half * .52f, line = std::max(1.f, box.half / 8);
    const ImVec2 left{box.middle.x - wide, box.middle.y}, right{box.middle.x + wide, box.middle.y};
    for (const float side : {-1.f, 1.f}) {
        if (side < 0 && !open) continue;
        const float bow = box.middle.y + side * 2 * high * (open ? 1 : .7f);
        list.AddBezierQuadratic(left, {box.middle.x, bow}, right, ink, line);
    }
    if (open) return list.AddCircleFilled(box.middle, box.half * .26f, ink);
    // Lashes.
    for (const float x : {-.5f, 0.f, .5f})
        list.AddLine({box.middle.x + x * wide, box.middle.y + box.half * (.36f - .2f * std::abs(x))},
                     {box.middle.x + 1.35f * x * wide, box.middle.y + box.half * (.66f - .2f * std::abs(x))}, ink,
                     line);
}

void drawLock(const Square& box, bool closed) {
    ImDrawList& list = *ImGui::GetWindowDrawList();
    const ImU32 ink = inkOf(box, closed);
    const float wide = box.half * .46f, line = std::max(1.f, box.half / 7), top = box.middle.y - box.half * .05f;
    const ImVec2 low{box.middle.x - wide, top}, high{box.middle.x + wide, box.middle.y + box.half * .6f};
    if (closed)
        list.AddRectFilled(low, high, ink, line);
    else
        list.AddRect(low, high, ink, line, 0, line);
    const float radius = wide * .66f, middle = closed ? box.middle.x : box.middle.x + .9f * wide;
    list.PathLineTo({middle - radius, top});
    list.PathArcTo({middle, top - radius * .7f}, radius, 3.1415927f, 6.2831853f);
    if (closed) list.PathLineTo({middle + radius, top});
    list.PathStroke(ink, 0, line);
}

}  // namespace

bool eyeBox(const char* id, bool* open) {
    const Square box = square(id);
    if (box.pressed) *open = !*open;
    drawEye(box, *open);
    return box.pressed;
}

bool lockBox(const char* id, bool* closed) {
    const Square box = square(id);
    if (box.pressed) *closed = !*closed;
    drawLock(box, *closed);
    return box.pressed;
}

}  // namespace sample
