// The canvas of nodes as it is drawn: only what is seen of it.
#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "sample_game/graph_parts.hpp"
#include "sample_game/panels.hpp"
#include "sample_game/theme.hpp"

namespace sample {
namespace {

using espalier::document::GraphGiven;
using espalier::document::GraphNode;
using espalier::document::NodePort;
using NodeBoxAt = NodeCanvas::Box;
using Port = NodeCanvas::Port;

constexpr float kLetters = 12.5f, kLeastLetters = 5;  // of the canvas' lengths; pixels
constexpr float kLeastDetail = .3f;                   // pixels to the canvas' lengths, below which nodes are spots

ImVec2 point(glm::vec2 v) {
    return {v.x, v.y};
}

struct Pen {
    const GraphDesk& desk;
    ImDrawList& list;
    float pixels = 1, letters = 0;  // of one length of the canvas; of a letter's height, 0: none are drawn
    glm::vec2 low{0}, high{0};      // of the canvas that is seen

    bool seen(glm::vec2 least, glm::vec2 most) const {
        return most.x >= low.x && most.y >= low.y && least.x <= high.x && least.y <= high.y;
    }
    void text(glm::vec2 at, ImU32 colour, const std::string& words, float room) const {
        if (letters == 0 || room <= 0) return;
        const ImVec2 from = point(desk.toWindow(at));
        const ImVec4 clip{from.x, from.y - letters, from.x + room * pixels, from.y + 2 * letters};
        list.AddText(ImGui::GetFont(), letters, from, colour, words.c_str(), nullptr, 0, &clip);
    }
    float width(const std::string& words) const {
        return ImGui::GetFont()->CalcTextSizeA(kLetters, 1e9f, 0, words.c_str()).x;
    }
};

void drawGrid(const Pen& pen) {
    constexpr float kStep = 40;
    if (kStep * pen.pixels < 8) return;
    const ImU32 colour = IM_COL32(255, 255, 255, 10);
    const ImVec2 least = point(pen.desk.low), most = point(pen.desk.high);
    for (float x = std::floor(pen.low.x / kStep) * kStep; x < pen.high.x; x += kStep) {
        const float at = std::floor(pen.desk.toWindow({x, 0}).x);
        pen.list.AddLine({at, least.y}, {at, most.y}, colour);
    }
    for (float y = std::floor(pen.low.y / kStep) * kStep; y < pen.high.y; y += kStep) {
        const float at = std::floor(pen.desk.toWindow({0, y}).y);
        pen.list.AddLine({least.x, at}, {most.x, at}, colour);
    }
}

void drawWire(const Pen& pen, glm::vec2 from, glm::vec2 to, ImU32 colour, float thick) {
    if (pen.pixels < kLeastDetail)
        return pen.list.AddLine(point(pen.desk.toWindow(from)), point(pen.desk.toWindow(to)), colour);
    const float bend = NodeCanvas::bend(from, to);
    pen.list.AddBezierCubic(point(pen.desk.toWindow(from)), point(pen.desk.toWindow(from + glm::vec2(bend, 0))),
                            point(pen.desk.toWindow(to - glm::vec2(bend, 0))), point(pen.desk.toWindow(to)), colour,
                            std::max(1.f, thick * pen.pixels));
}

void drawWires(const Pen& pen) {
    const NodeCanvas& canvas = pen.desk.canvas;
    for (const NodeCanvas::Wire& wire : canvas.wires) {
        const glm::vec2 a = canvas.placeOf(wire.from), b = canvas.placeOf(wire.to);
        const glm::vec2 around(NodeCanvas::bend(a, b), 2);
        if (!pen.seen(glm::min(a, b) - around, glm::max(a, b) + around)) continue;
        const auto& taken = pen.desk.drag.taken;
        if (taken && taken->to == wire.to && taken->place == wire.place) continue;
        const auto type = pen.desk.typeOf(wire.from);
        const bool near = pen.desk.selected.contains(pen.desk.nameAt(wire.from.node)) ||
                          pen.desk.selected.contains(pen.desk.nameAt(wire.to.node));
        drawWire(pen, a, b, nodeColour(type.value_or(ESP_NODE_GEOMETRY)), near ? 2.6f : 1.7f);
    }
}

// What stands beside an input that isn't wired.
std::string shownValue(const NodePort& port, const GraphGiven* given) {
    if (espalier::document::isText(port.type)) return given ? given->text : port.text;
    GraphGiven value;
    const int numbers = espalier::document::numbersOf(port.type);
    if (numbers == 0) return "";
    value.kind = numbers == 3 ? ESP_GRAPH_VECTOR : ESP_GRAPH_NUMBER;
    value.numbers = given ? given->numbers : port.standard;
    if (numbers == 1) return espalier::document::valueText(value);
    char text[64];
    std::snprintf(text, sizeof text, "%.3g %.3g %.3g", double(value.numbers[0]), double(value.numbers[1]),
                  double(value.numbers[2]));
    return text;
}

void drawPort(const Pen& pen, const Port& port, ImU32 colour, bool wired, bool missing) {
    const ImVec2 at = point(pen.desk.toWindow(pen.desk.canvas.placeOf(port)));
    const float r = std::max(1.5f, NodeCanvas::kPort * pen.pixels);
    pen.list.AddCircleFilled(at, r, wired ? colour : IM_COL32(30, 31, 30, 255));
    pen.list.AddCircle(at, r, missing ? ImGui::GetColorU32(kBad) : colour, 0, std::max(1.f, 1.4f * pen.pixels));
}

void drawRows(const Pen& pen, uint32_t n, const NodeBoxAt& box) {
    const GraphNode& node = pen.desk.nodeAt(n);
    const ImU32 light = ImGui::GetColorU32(ImGuiCol_Text), faint = ImGui::GetColorU32(ImGuiCol_TextDisabled);
    const auto type = [&](const Port& port) { return nodeColour(pen.desk.typeOf(port).value_or(ESP_NODE_GEOMETRY)); };
    const float drop = .5f * (NodeCanvas::kRow - kLetters);
    for (uint32_t o = 0; o < box.outputs; ++o) {
        const Port port{n, o, true};
        const std::string name = box.kind ? box.kind->outputs[o].name : "out";
        const glm::vec2 at =
            pen.desk.canvas.placeOf(port) - glm::vec2(10 + pen.width(name), .5f * NodeCanvas::kRow - drop);
        pen.text(at, faint, name, NodeCanvas::kWidth);
        drawPort(pen, port, type(port), true, false);
    }
    for (uint32_t i = 0; i < box.inputs; ++i) {
        const Port port{n, i, false};
        const std::string name = pen.desk.inputName(port);
        const GraphGiven* given = box.kind ? node.given(name) : &node.inputs[i];
        const bool wired = given && given->wire();
        const glm::vec2 at = pen.desk.canvas.placeOf(port) + glm::vec2(10, -.5f * NodeCanvas::kRow + drop);
        const float wide = pen.letters == 0 ? 0 : pen.width(name);
        pen.text(at, light, name, NodeCanvas::kWidth - 14);
        const bool needed = box.kind && box.kind->inputs[i].wired;
        if (!wired && box.kind && !needed && pen.letters > 0) {
            const std::string value = shownValue(box.kind->inputs[i], given);
            const float room = NodeCanvas::kWidth - 26 - wide, size = std::min(room, pen.width(value));
            pen.text(at + glm::vec2(NodeCanvas::kWidth - 18 - size, 0), given ? IM_COL32(150, 200, 245, 255) : faint,
                     value, room);
        }
        const bool takes = box.kind && !wired && espalier::document::numbersOf(box.kind->inputs[i].type) == 0 &&
                           espalier::document::isText(box.kind->inputs[i].type);
        if (!takes) drawPort(pen, port, type(port), wired, needed && !wired);
    }
}

// An eye in the title's right end: open, if the node is shown.
void drawEye(const Pen& pen, const NodeBoxAt& box, bool shown) {
    if (pen.letters == 0) return;
    const ImVec2 c = point(pen.desk.toWindow(box.at + glm::vec2(box.size.x - 13, .5f * NodeCanvas::kTitle)));
    const float w = 7 * pen.pixels, h = 4.6f * pen.pixels;
    const ImU32 colour = shown ? IM_COL32(250, 240, 200, 255) : IM_COL32(255, 255, 255, 70);
    ImDrawList& list = pen.list;
    list.PathLineTo({c.x - w, c.y});
    list.PathBezierCubicCurveTo({c.x - .4f * w, c.y - 1.5f * h}, {c.x + .4f * w, c.y - 1.5f * h}, {c.x + w, c.y});
    list.PathBezierCubicCurveTo({c.x + .4f * w, c.y + 1.5f * h}, {c.x - .4f * w, c.y + 1.5f * h}, {c.x - w, c.y});
    list.PathStroke(colour, ImDrawFlags_Closed, std::max(1.f, 1.2f * pen.pixels));
    if (shown) list.AddCircleFilled(c, 2.6f * pen.pixels, colour);
}

void drawNode(const Workspace& work, const Pen& pen, uint32_t n) {
    const GraphDesk& desk = pen.desk;
    const GraphNode& node = desk.nodeAt(n);
    const NodeBoxAt box = desk.canvas.boxes[n];
    const bool selected = desk.selected.contains(node.name), shown = desk.model.isShown(node.name);
    const EspNodeState state = nodeState(work, node.name);
    const bool failed = state.failure && *state.failure, muted = desk.model.isMuted(node.name);
    const ImVec2 a = point(desk.toWindow(box.at)), b = point(desk.toWindow(box.at + box.size));
    const float round = 4 * pen.pixels, title = a.y + NodeCanvas::kTitle * pen.pixels;
    const int alpha = muted ? 120 : 255;
    ImU32 head = IM_COL32(58, 66, 58, alpha);
    if (box.kind && !box.kind->outputs.empty()) {
        // A title has a shade of what the node gives.
        const ImU32 type = nodeColour(box.kind->outputs[0].type);
        const auto mixed = [&](int shift) { return int(40 + .28f * float(type >> shift & 255)); };
        head = IM_COL32(mixed(IM_COL32_R_SHIFT), mixed(IM_COL32_G_SHIFT), mixed(IM_COL32_B_SHIFT), alpha);
    }
    if (failed || !box.kind) head = IM_COL32(140, 44, 34, alpha);
    if (pen.pixels < kLeastDetail)  // as a spot of colour
        return pen.list.AddRectFilled(a, b, selected ? IM_COL32(240, 245, 235, 255) : head);
    if (pen.pixels > .4f) pen.list.AddRectFilled({a.x + 3, a.y + 4}, {b.x + 4, b.y + 5}, IM_COL32(0, 0, 0, 70), round);
    pen.list.AddRectFilled(a, b, IM_COL32(44, 46, 44, alpha), round);
    pen.list.AddRectFilled(a, {b.x, title}, head, round, ImDrawFlags_RoundCornersTop);
    const bool noted = state.note && *state.note;
    const ImU32 edge = selected                   ? IM_COL32(240, 245, 235, 255)
                       : failed                   ? ImGui::GetColorU32(kBad)
                       : state.waits > 0 || noted ? IM_COL32(200, 150, 60, 255)
                       : shown                    ? IM_COL32(190, 180, 120, 255)
                                                  : IM_COL32(20, 21, 20, 255);
    pen.list.AddRect(a, b, edge, round, 0, selected ? std::max(1.5f, 2 * pen.pixels) : 1);
    const float drop = .5f * (NodeCanvas::kTitle - kLetters);
    const ImU32 light = ImGui::GetColorU32(ImGuiCol_Text);
    pen.text(box.at + glm::vec2(8, drop), light, node.name, NodeCanvas::kWidth - 36);
    // The kind stands behind the name where that isn't the kind's own.
    const float wide = pen.letters > 0 ? pen.width(node.name) + 8 : 0;
    pen.text(box.at + glm::vec2(8 + wide, drop), IM_COL32(255, 255, 255, 110), node.kind,
             NodeCanvas::kWidth - 36 - wide);
    if (box.kind && !box.kind->outputs.empty() && espalier::document::canBeShown(box.kind->outputs[0].type))
        drawEye(pen, box, shown);
    drawRows(pen, n, box);
    if (muted)
        pen.list.AddLine({a.x, .5f * (title + b.y)}, {b.x, .5f * (title + b.y)}, IM_COL32(210, 80, 70, 220),
                         std::max(1.f, 2 * pen.pixels));
}

void drawDrag(const Pen& pen) {
    const auto& drag = pen.desk.drag;
    const ImVec2 mouse = ImGui::GetIO().MousePos;
    const glm::vec2 at = pen.desk.toCanvas({mouse.x, mouse.y});
    if (drag.kind == GraphDesk::Drag::box) {
        const ImVec2 a = point(pen.desk.toWindow(glm::min(drag.from, at)));
        const ImVec2 b = point(pen.desk.toWindow(glm::max(drag.from, at)));
        pen.list.AddRectFilled(a, b, IM_COL32(160, 210, 140, 30));
        pen.list.AddRect(a, b, IM_COL32(160, 210, 140, 180));
    }
    if (drag.kind != GraphDesk::Drag::wire) return;
    const glm::vec2 fixed = pen.desk.canvas.placeOf(drag.port);
    glm::vec2 end = at;
    ImU32 colour = nodeColour(pen.desk.typeOf(drag.port).value_or(ESP_NODE_GEOMETRY));
    std::string why;
    if (const auto port = pen.desk.canvas.portNear(at, 12); port && port->output != drag.port.output) {
        end = pen.desk.canvas.placeOf(*port);
        const Port &output = drag.port.output ? drag.port : *port, &input = drag.port.output ? *port : drag.port;
        if (!pen.desk.fits(output, input, why)) colour = ImGui::GetColorU32(kBad);
    }
    drag.port.output ? drawWire(pen, fixed, end, colour, 2.6f) : drawWire(pen, end, fixed, colour, 2.6f);
    if (!why.empty()) tip(why.c_str());
}

}  // namespace

uint32_t nodeColour(EspNodeType type) {
    switch (type) {
        case ESP_NODE_NUMBER:
        case ESP_NODE_WHOLE:
            return IM_COL32(160, 160, 165, 255);
        case ESP_NODE_VECTOR:
            return IM_COL32(120, 120, 215, 255);
        case ESP_NODE_COLOUR:
            return IM_COL32(215, 200, 80, 255);
        case ESP_NODE_CHOICE:
        case ESP_NODE_TEXT:
        case ESP_NODE_FILE:
            return IM_COL32(110, 175, 200, 255);
        case ESP_NODE_MATERIAL:
            return IM_COL32(215, 110, 110, 255);
        case ESP_NODE_GRAMMAR:
            return IM_COL32(185, 140, 220, 255);
        case ESP_NODE_SURFACE:
            return IM_COL32(170, 140, 110, 255);
        case ESP_NODE_PLANTS:
            return IM_COL32(130, 190, 60, 255);
        case ESP_NODE_TOWN:
        case ESP_NODE_LAYER:
            return IM_COL32(205, 120, 80, 255);
        case ESP_NODE_POINTS:
            return IM_COL32(225, 160, 80, 255);
        case ESP_NODE_CURVES:
            return IM_COL32(90, 195, 200, 255);
        case ESP_NODE_MESH:
            return IM_COL32(110, 200, 120, 255);
        case ESP_NODE_GEOMETRY:
            break;
    }
    return IM_COL32(80, 190, 165, 255);
}

void drawCanvas(Workspace& work, GraphDesk& desk) {
    ImDrawList& list = *ImGui::GetWindowDrawList();
    Pen pen{desk, list, desk.pixels(), kLetters * desk.pixels(), desk.toCanvas(desk.low), desk.toCanvas(desk.high)};
    if (pen.letters < kLeastLetters) pen.letters = 0;
    list.PushClipRect(point(desk.low), point(desk.high), true);
    list.AddRectFilled(point(desk.low), point(desk.high), IM_COL32(24, 25, 24, 255));
    drawGrid(pen);
    drawWires(pen);
    for (uint32_t n = 0; n < desk.canvas.boxes.size(); ++n) {
        const NodeBoxAt& box = desk.canvas.boxes[n];
        if (pen.seen(box.at - 8.f, box.at + box.size + 8.f)) drawNode(work, pen, n);
    }
    drawDrag(pen);
    if (desk.canvas.boxes.empty()) {
        const char* words = "Tab: add a node";
        const ImVec2 size = ImGui::CalcTextSize(words);
        list.AddText({.5f * (desk.low.x + desk.high.x - size.x), .5f * (desk.low.y + desk.high.y - size.y)},
                     ImGui::GetColorU32(ImGuiCol_TextDisabled), words);
    }
    list.PopClipRect();
}

}  // namespace sample
