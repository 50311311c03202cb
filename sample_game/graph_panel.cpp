// The inputs of the node that is selected, beside the canvas: values with their ranges and units, and wires.
#include <imgui.h>

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <cstdio>
#include <cstring>

#include "sample_game/graph_parts.hpp"
#include "sample_game/panels.hpp"
#include "sample_game/theme.hpp"

namespace sample {
namespace {

using namespace espalier::document;

struct Row {
    const GraphDesk& desk;
    const GraphNode& node;
    const NodePort& port;
    const GraphGiven* given;  // null: the standard
};

void setValue(Workspace& work, const Row& row, const std::string& value, uint32_t gesture) {
    work.perform(SetNodeInput{row.desk.graph, row.node.name, row.port.name, value}, gesture);
}

void wiresAt(Workspace& work, const Row& row) {
    uint32_t place = 0;
    for (const GraphGiven& given : row.node.inputs) {
        if (given.input != row.port.name) continue;
        const uint32_t at = place++;
        if (!given.wire()) continue;
        ImGui::PushID(int(at));
        const std::string from = "\u2190 " + valueText(given);
        ImGui::AlignTextToFramePadding();
        ImGui::TextUnformatted(shortened(from, ImGui::GetContentRegionAvail().x - 2 * ImGui::GetFrameHeight()).c_str());
        ImGui::SameLine(ImGui::GetWindowContentRegionMax().x - ImGui::GetFrameHeight());
        if (ImGui::Button("x", {ImGui::GetFrameHeight(), 0}))
            work.perform(ConnectNodes{row.desk.graph, row.node.name, row.port.name, "", at}, work.newGesture());
        toolTip("Takes the wire away");
        ImGui::PopID();
    }
}

// As much as a drag of a pixel changes: of what is large more.
float dragSpeed(float value, const NodePort& port) {
    const float range = port.high - port.low;
    if (range > 0 && range <= 1000) return std::max(range / 400, 1e-4f);
    return std::max(.005f * std::abs(value), .002f);
}

void numbers(Workspace& work, const Row& row) {
    const int count = numbersOf(row.port.type);
    GraphGiven value;
    value.kind = count == 3 ? ESP_GRAPH_VECTOR : ESP_GRAPH_NUMBER;
    value.numbers = row.given ? row.given->numbers : row.port.standard;
    const bool ranged = row.port.high > row.port.low;
    const float low = ranged ? row.port.low : -FLT_MAX, high = ranged ? row.port.high : FLT_MAX;
    bool changed = false;
    if (row.port.type == ESP_NODE_COLOUR) {
        changed = editColour("##value", value.numbers.data());
    } else if (row.port.type == ESP_NODE_WHOLE) {
        float& number = value.numbers[0];
        const float speed = std::max(.05f, .004f * std::abs(number));
        changed = ImGui::DragFloat("##value", &number, speed, low, high, "%.0f", ImGuiSliderFlags_AlwaysClamp);
        number = std::round(number);
    } else {
        const float largest =
            std::max({std::abs(value.numbers[0]), std::abs(value.numbers[1]), std::abs(value.numbers[2])});
        changed = ImGui::DragScalarN("##value", ImGuiDataType_Float, value.numbers.data(), count,
                                     dragSpeed(largest, row.port), &low, &high, "%.5g", ImGuiSliderFlags_AlwaysClamp);
    }
    const bool finite = std::ranges::all_of(value.numbers, [](float v) { return std::isfinite(v); });
    if (changed && finite) setValue(work, row, valueText(value), widgetGesture(work));
}

void words(Workspace& work, const Row& row) {
    const std::string now = row.given ? row.given->text : row.port.text;
    GraphGiven value;
    value.kind = ESP_GRAPH_TEXT;
    if (row.port.type == ESP_NODE_CHOICE) {
        if (!beginCombo("##value", now)) return;
        for (const std::string& word : row.port.words) {
            value.text = word;
            if (ImGui::Selectable(word.c_str(), word == now)) setValue(work, row, valueText(value), work.newGesture());
        }
        ImGui::EndCombo();
        return;
    }
    char text[512];
    std::snprintf(text, sizeof text, "%s", now.c_str());
    (void)ImGui::InputText("##value", text, sizeof text);
    value.text = text;
    if (ImGui::IsItemDeactivatedAfterEdit() && value.text != now)
        setValue(work, row, valueText(value), work.newGesture());
}

std::string tipOf(const NodePort& port) {
    std::string text = port.help.empty() ? port.name : port.help;
    if (port.high > port.low) text += "\n" + shortText(port.low) + " to " + shortText(port.high);
    if (!port.unit.empty()) text += " " + port.unit;
    if (numbersOf(port.type) > 0) text += "\nDrag, or double-click to type";
    return text;
}

// Behind its label, or below it where three numbers need the room.
void valueOf(Workspace& work, const Row& row) {
    const float reset = row.given ? ImGui::GetFrameHeight() + ImGui::GetStyle().ItemInnerSpacing.x : 0;
    const bool below = row.port.type == ESP_NODE_VECTOR;
    if (!below) ImGui::SameLine(.42f * ImGui::GetWindowContentRegionMax().x);
    ImGui::SetNextItemWidth(-std::max(reset, FLT_MIN));
    ImGui::BeginGroup();
    numbersOf(row.port.type) > 0 ? numbers(work, row) : words(work, row);
    ImGui::EndGroup();
    toolTip(tipOf(row.port).c_str());
    if (!row.given) return;
    ImGui::SameLine(0, ImGui::GetStyle().ItemInnerSpacing.x);
    if (ImGui::Button("\u21BA", {ImGui::GetFrameHeight(), 0})) setValue(work, row, "", work.newGesture());
    toolTip("Back to the kind's standard value");
}

void inputRow(Workspace& work, const Row& row) {
    ImGui::PushID(row.port.name.c_str());
    const std::string name = row.port.unit.empty() ? row.port.name : row.port.name + ", " + row.port.unit;
    ImGui::AlignTextToFramePadding();
    if (row.given)
        ImGui::TextUnformatted(name.c_str());
    else
        ImGui::TextDisabled("%s", name.c_str());
    toolTip(tipOf(row.port).c_str());
    if (row.given && row.given->wire()) {
        wiresAt(work, row);
    } else if (row.port.opener.empty() && (numbersOf(row.port.type) > 0 || isText(row.port.type))) {
        valueOf(work, row);
    } else {
        ImGui::SameLine();
        ImGui::TextColored(row.port.wired ? kWarning : ImGui::GetStyleColorVec4(ImGuiCol_TextDisabled),
                           "waits for a wire to %s",
                           row.port.opener.empty() ? espNodeTypeName(row.port.type) : row.port.opener.c_str());
    }
    ImGui::PopID();
}

void header(Workspace& work, GraphDesk& desk, const GraphNode& node, const NodeKind* kind) {
    ImGui::AlignTextToFramePadding();
    ImGui::TextColored(kGood, "%s", node.name.c_str());
    ImGui::SameLine();
    ImGui::TextDisabled("%s", node.kind.c_str());
    if (kind) toolTip(kind->help.c_str());
    ImGui::SameLine(ImGui::GetWindowContentRegionMax().x - 4.2f * ImGui::GetFontSize());
    if (ImGui::SmallButton("rename")) desk.renaming = node.name;
    if (kind) aside(kind->help.c_str());
    const EspNodeState state = nodeState(work, node.name);
    if (state.failure && *state.failure) {
        ImGui::PushStyleColor(ImGuiCol_Text, kBad);
        ImGui::TextWrapped("%s", state.failure);
        ImGui::PopStyleColor();
        if (state.made) aside("What it made last stands until it can be made again.");
    } else if (const std::string made = stateText(state); !made.empty()) {
        if (state.ms >= 0)
            ImGui::TextDisabled("%s; %.3g ms", made.c_str(), state.ms);
        else
            ImGui::TextDisabled("%s", made.c_str());
    }
    if (state.note && *state.note) ImGui::TextColored(kWarning, "%s", state.note);
}

}  // namespace

void nodePanel(Workspace& work, GraphDesk& desk) {
    if (desk.selected.size() != 1) {
        aside(desk.selected.empty()
                  ? "Click a node: its values are here. Tab adds one, a drag from a port wires it, the "
                    "eye shows what it makes."
                  : (std::to_string(desk.selected.size()) + " nodes are selected").c_str());
        return;
    }
    const int n = desk.model.find(*desk.selected.begin());
    if (n < 0) return;
    const GraphNode node = desk.model.nodes[size_t(n)];  // an edit reads the model anew
    const NodeKind* kind = findNodeKind(node.kind);
    ImGui::PushID(node.name.c_str());
    header(work, desk, node, kind);
    ImGui::Separator();
    if (kind)
        for (const NodePort& port : kind->inputs) inputRow(work, {desk, node, port, node.given(port.name)});
    else
        hint("This version doesn't know this kind of node. It stays as it is written.");
    ImGui::PopID();
}

}  // namespace sample
