// The brush: what it paints with and where it may.
#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "sample_game/panels.hpp"
#include "tools/scene/layers.hpp"

namespace sample {
namespace {

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

// The values that the layer's grammar has names for, to be taken by a click.
void valueButtons(const Workspace& work, Brush& brush) {
    const std::string label = espalier::scene::labelOf(work.context.get(), work.scene(), brush.layer);
    const auto values = espalier::scene::labelWords(label).values;
    ImGui::PushID("named");
    for (const auto& named : values) {
        ImGui::PushID(int(&named - values.data()));
        const float width = ImGui::CalcTextSize(named.name.c_str()).x + 2 * ImGui::GetStyle().FramePadding.x;
        if (&named != &values.front()) sameLineIfRoom(width);
        if (chosenButton(named.name.c_str(), brush.value == named.value, {0, 0})) brush.value = named.value;
        char tip[64];
        std::snprintf(tip, sizeof tip, "Paints %.2g", double(named.value));
        toolTip(tip);
        ImGui::PopID();
    }
    ImGui::PopID();
}

const char* metresOf(float radius) {
    return radius < .1f ? "%.3f m" : "%.2f m";
}

}  // namespace

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
    labelledSlider("Radius", &work.brushRadius(), kSmallestBrush, kLargestBrush, metresOf(work.brushRadius()), true);
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
        toolTip("What is painted. X: the opposite");
        valueButtons(work, b);
    }
    labelledSlider("Spacing", &b.spacing, .05f, 1, "%.2f");
    toolTip("Between two dabs, of the radius");
    if (work.townLayer(b.layer)) return;
    limits(work, b);
    checkBox("Only what faces as the centre does", &b.frontOnly);
    toolTip("A brush on a thin wall leaves its back alone");
}

}  // namespace sample
