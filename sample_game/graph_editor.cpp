// The node editor below the view: what the mouse and the keys do on its canvas.
#define GLFW_INCLUDE_NONE
#include "sample_game/graph_editor.hpp"

#include <GLFW/glfw3.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>

#include "sample_game/graph_parts.hpp"
#include "sample_game/panels.hpp"
#include "sample_game/theme.hpp"

namespace sample {
namespace {

using namespace espalier::document;
using CanvasDrag = GraphDesk::Drag;
using Port = NodeCanvas::Port;

constexpr float kLeastZoom = .1f, kMostZoom = 3, kPortReach = 9;
constexpr int kDockFlags = ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoResize |
                           ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_NoBringToFrontOnFocus |
                           ImGuiWindowFlags_NoScrollbar | ImGuiWindowFlags_NoScrollWithMouse | ImGuiWindowFlags_NoNav |
                           kQuiet;

glm::vec2 mouseAt() {
    return {ImGui::GetIO().MousePos.x, ImGui::GetIO().MousePos.y};
}

bool overEye(const GraphDesk& desk, uint32_t n, glm::vec2 at) {
    const NodeCanvas::Box& box = desk.canvas.boxes[n];
    return at.x > box.at.x + box.size.x - 24 && at.y < box.at.y + NodeCanvas::kTitle;
}

// What lies at an input already, to be led elsewhere; the last of several.
std::optional<NodeCanvas::Wire> wireAt(const GraphDesk& desk, const Port& input) {
    std::optional<NodeCanvas::Wire> last;
    for (const NodeCanvas::Wire& wire : desk.canvas.wires)
        if (wire.to == input) last = wire;
    return last;
}

bool takesMany(const GraphDesk& desk, const Port& input) {
    const NodeKind* kind = desk.canvas.boxes[input.node].kind;
    return kind && kind->inputs[input.index].many;
}

void beginWire(GraphDesk& desk, const Port& port) {
    desk.drag.kind = CanvasDrag::wire;
    desk.drag.port = port;
    desk.drag.taken.reset();
    if (port.output) return;
    const auto wire = wireAt(desk, port);
    if (!wire || takesMany(desk, port)) return;
    desk.drag.taken = wire;
    desk.drag.port = wire->from;
}

void pressLeft(Workspace& work, GraphDesk& desk, glm::vec2 at) {
    const ImGuiIO& io = ImGui::GetIO();
    auto& drag = desk.drag;
    drag = {};
    drag.from = at;
    drag.more = io.KeyShift;
    if (io.KeyAlt) return void(drag.kind = CanvasDrag::pan);
    if (const auto port = desk.canvas.portNear(at, kPortReach)) return beginWire(desk, *port);
    const auto node = desk.canvas.nodeAt(at);
    if (!node) return void(drag.kind = CanvasDrag::box);
    if (overEye(desk, *node, at)) return showNode(work, desk, desk.nameAt(*node), io.KeyShift);
    drag.kind = CanvasDrag::press;
    drag.node = *node;
    const std::string& name = desk.nameAt(*node);
    if (drag.more && desk.selected.contains(name)) {
        desk.selected.erase(name);
        drag.kind = CanvasDrag::none;
    } else if (!desk.selected.contains(name)) {
        if (!drag.more) desk.selected.clear();
        desk.selected.insert(name);
    }
    if (ImGui::IsMouseDoubleClicked(0)) desk.renaming = name, drag.kind = CanvasDrag::none;
}

void moveNodes(GraphDesk& desk, glm::vec2 at) {
    const glm::vec2 moved = at - desk.drag.from, step = moved - desk.drag.moved;
    for (const std::string& name : desk.selected)
        if (const int n = desk.model.find(name); n >= 0) desk.canvas.boxes[size_t(n)].at += step;
    desk.drag.moved = moved;
}

// A single node that was let go over a wire, and through which that can lead, becomes a part of its way.
void insertInWire(Workspace& work, const GraphDesk& desk, uint32_t gesture) {
    if (desk.selected.size() != 1) return;
    const int n = desk.model.find(*desk.selected.begin());
    const NodeCanvas::Box& box = desk.canvas.boxes[size_t(n)];
    const auto own = [&](const NodeCanvas::Wire& wire) {
        return wire.from.node == uint32_t(n) || wire.to.node == uint32_t(n);
    };
    if (!box.kind || box.kind->outputs.empty() || std::ranges::any_of(desk.canvas.wires, own)) return;
    const auto at = desk.canvas.wireNear(box.at + .5f * box.size, .5f * NodeCanvas::kTitle + 12);
    if (!at) return;
    const NodeCanvas::Wire wire = desk.canvas.wires[*at];
    std::string why;
    for (uint32_t i = 0; i < box.inputs; ++i) {
        const auto given = desk.typeOf(wire.from);
        const auto taken = desk.typeOf(wire.to);
        const EspNodeType gives =
            box.kind->outputs[0].asFirst && i == 0 ? given.value_or(ESP_NODE_GEOMETRY) : box.kind->outputs[0].type;
        if (!desk.fits(wire.from, {uint32_t(n), i, false}, why) || !desk.fits({uint32_t(n), 0, true}, wire.to, why) ||
            (taken && !espNodeTypeTakes(*taken, gives)))
            continue;
        connect(work, desk, wire.from, {uint32_t(n), i, false}, {}, gesture);
        connect(work, desk, {uint32_t(n), 0, true}, wire.to, wire, gesture);
        work.document->callStep(gesture, "Insert " + desk.nameAt(uint32_t(n)));
        return;
    }
}

void dropNodes(Workspace& work, GraphDesk& desk) {
    MoveNodes move{desk.graph, {}, {}};
    for (const std::string& name : desk.selected) {
        const NodeCanvas::Box& box = desk.canvas.boxes[size_t(desk.model.find(name))];
        move.nodes.push_back(name);
        move.places.push_back({std::round(box.at.x), std::round(box.at.y)});
    }
    const uint32_t gesture = work.newGesture();
    if (!work.perform(move, gesture)) return desk.canvas.build(desk.model);
    insertInWire(work, desk, gesture);
}

void dropWire(Workspace& work, GraphDesk& desk, glm::vec2 at) {
    const auto [port, taken] = std::pair(desk.drag.port, desk.drag.taken);
    const auto end = desk.canvas.portNear(at, 12);
    const bool fitsThere = end && end->output != port.output && end->node != port.node;
    if (fitsThere) {
        const Port &output = port.output ? port : *end, &input = port.output ? *end : port;
        if (taken && taken->to == input) return;  // where it was
        std::string why;
        if (!desk.fits(output, input, why)) {
            work.error = why;
            return;
        }
        const uint32_t gesture = work.newGesture();
        if (taken) connect(work, desk, {}, taken->to, taken, gesture);
        return connect(work, desk, output, input, {}, gesture);
    }
    if (desk.canvas.nodeAt(at)) return;
    if (taken)
        connect(work, desk, {}, taken->to, taken, work.newGesture());
    else
        askForNode(desk, at, port);
}

void selectWithin(GraphDesk& desk, glm::vec2 a, glm::vec2 b, bool more) {
    const glm::vec2 low = glm::min(a, b), high = glm::max(a, b);
    if (!more) desk.selected.clear();
    for (uint32_t n = 0; n < desk.canvas.boxes.size(); ++n) {
        const NodeCanvas::Box& box = desk.canvas.boxes[n];
        if (box.at.x <= high.x && box.at.y <= high.y && box.at.x + box.size.x >= low.x &&
            box.at.y + box.size.y >= low.y)
            desk.selected.insert(desk.nameAt(n));
    }
}

void release(Workspace& work, GraphDesk& desk, glm::vec2 at) {
    const CanvasDrag kind = desk.drag.kind;
    if (kind == CanvasDrag::press && !desk.drag.more) desk.selected = {desk.nameAt(desk.drag.node)};
    if (kind == CanvasDrag::box) selectWithin(desk, desk.drag.from, at, desk.drag.more);
    if (kind == CanvasDrag::nodes) dropNodes(work, desk);
    if (kind == CanvasDrag::wire) dropWire(work, desk, at);
    desk.drag.kind = CanvasDrag::none;
    desk.drag.taken.reset();
}

void zoomBy(GraphDesk& desk, float steps, glm::vec2 window) {
    const glm::vec2 before = desk.toCanvas(window);
    desk.zoom = std::clamp(desk.zoom * std::pow(1.15f, steps), kLeastZoom, kMostZoom);
    desk.pan += before - desk.toCanvas(window);
}

// What a node has made and how long that took.
void nodeTip(Workspace& work, const GraphDesk& desk, uint32_t n) {
    const GraphNode& node = desk.nodeAt(n);
    const EspNodeState state = nodeState(work, node.name);
    std::string text = node.name + " (" + node.kind + ")";
    if (state.failure && *state.failure) text += "\n" + std::string(state.failure);
    if (state.waits) text += "\nIt stands as it was last: something that it reads has failed";
    if (const std::string made = stateText(state); !made.empty()) text += "\n" + made;
    if (state.note && *state.note) text += "\n" + std::string(state.note);
    char took[64];
    std::snprintf(took, sizeof took, "\n%.3g ms the last time, made %u times", state.ms, state.evaluations);
    if (state.made && state.ms >= 0) text += took;
    if (!state.made && !(state.failure && *state.failure)) text += "\nNothing reads it that is shown, so it isn't made";
    if (node.comments) text += "\n" + *node.comments;
    tip(text.c_str());
}

void portTip(const GraphDesk& desk, const Port& port) {
    const NodeKind* kind = desk.canvas.boxes[port.node].kind;
    if (!kind) return;
    const NodePort& info = port.output ? kind->outputs[port.index] : kind->inputs[port.index];
    const auto type = desk.typeOf(port);
    std::string text = info.name + ": " + espNodeTypeName(type.value_or(info.type));
    if (info.many) text += ", any number of wires";
    if (!info.help.empty()) text += "\n" + info.help;
    tip(text.c_str());
}

void hoverCanvas(Workspace& work, const GraphDesk& desk, glm::vec2 at) {
    if (desk.drag.kind != CanvasDrag::none || toolTipWaits()) return;
    if (const auto port = desk.canvas.portNear(at, kPortReach)) return portTip(desk, *port);
    if (const auto node = desk.canvas.nodeAt(at)) nodeTip(work, desk, *node);
}

void contextMenu(Workspace& work, GraphDesk& desk) {
    if (!ImGui::BeginPopup("node menu")) return;
    const bool one = desk.selected.size() == 1;
    const std::string first = desk.selected.empty() ? "" : *desk.selected.begin();
    if (ImGui::MenuItem("Show", "E", one && desk.model.isShown(first), one)) showNode(work, desk, first, false);
    if (ImGui::MenuItem("Mute", "M", one && desk.model.isMuted(first))) muteSelected(work, desk);
    if (ImGui::MenuItem("Rename ...", nullptr, false, one)) desk.renaming = first;
    ImGui::Separator();
    if (ImGui::MenuItem("Copy", "Ctrl+C")) copySelected(work, desk);
    if (ImGui::MenuItem("Duplicate", "Shift+D")) duplicateSelected(work, desk);
    if (ImGui::MenuItem("Remove", "X")) removeSelected(work, desk, false);
    if (ImGui::MenuItem("Remove, keep the wire", "Ctrl+X")) removeSelected(work, desk, true);
    ImGui::EndPopup();
}

void toolRow(Workspace& work, GraphDesk& desk) {
    const auto& graphs = work.scene().graphs;
    const auto nameOf = [&](size_t i) { return std::filesystem::path(graphs[i].file).filename().string(); };
    ImGui::SetNextItemWidth(12 * ImGui::GetFontSize());
    if (beginCombo("##graph", nameOf(desk.graph))) {
        for (size_t i = 0; i < graphs.size(); ++i)
            if (ImGui::Selectable((nameOf(i) + "##" + std::to_string(i)).c_str(), i == desk.graph))
                work.graphs.open = uint32_t(i);
        ImGui::EndCombo();
    }
    toolTip(graphs[desk.graph].file.c_str());
    ImGui::SameLine();
    if (ImGui::Button("Add ...")) askForNode(desk, .5f * (desk.toCanvas(desk.low) + desk.toCanvas(desk.high)));
    toolTip("A new node  (Tab or Shift+A over the canvas)");
    ImGui::SameLine();
    if (chosenButton("Text", desk.textShown, {0, 0})) desk.textShown = !desk.textShown;
    toolTip("The same graph as text, beside it");
    ImGui::SameLine();
    writeGraphButton(work, desk);
    ImGui::SameLine();
    EspGraphStats stats;
    if (!graphs[desk.graph].error.empty()) {
        ImGui::TextColored(kBad, "The text has mistakes: the canvas shows what ran last");
    } else if (espGraphStats(work.context.get(), graphs[desk.graph].id, &stats) == ESP_OK) {
        ImGui::TextDisabled("%s vertices, %s triangles; the last change made %u of %u nodes in %.2f ms",
                            countText(stats.vertices).c_str(), countText(stats.triangles).c_str(), stats.evaluated,
                            stats.nodes, stats.ms);
    }
}

// The edge between view and node editor is dragged.
void splitter(Workspace& work, float top) {
    const float s = work.scale;
    ImGui::SetCursorScreenPos({ImGui::GetWindowPos().x, top});
    ImGui::InvisibleButton("edge", {ImGui::GetWindowWidth(), 5 * s});
    if (ImGui::IsItemHovered() || ImGui::IsItemActive()) ImGui::SetMouseCursor(ImGuiMouseCursor_ResizeNS);
    if (!ImGui::IsItemActive() || ImGui::GetIO().MouseDelta.y == 0) return;
    work.graphs.height =
        std::clamp(work.graphs.height - ImGui::GetIO().MouseDelta.y / s, 120.f, .7f * work.window.y / s);
    work.redraw = true;
}

void layOutDock(Workspace& work, GraphDesk& desk, float top, float high) {
    const float s = work.scale, left = work.panelUnits(), wide = work.window.x - left;
    ImGui::SetNextWindowPos({left, top});
    ImGui::SetNextWindowSize({wide, high});
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {8 * s, 6 * s});
    if (ImGui::Begin("nodes", nullptr, kDockFlags)) {
        splitter(work, top);
        ImGui::SetCursorScreenPos({left + 8 * s, top + 6 * s});
        toolRow(work, desk);
        const float side = std::min(270 * s, .35f * wide), text = desk.textShown ? std::min(380 * s, .35f * wide) : 0;
        const ImVec2 room = ImGui::GetContentRegionAvail();
        const ImVec2 size{std::max(60 * s, room.x - side - text - 8 * s), std::max(20 * s, room.y)};
        const ImVec2 at = ImGui::GetCursorScreenPos();
        desk.low = {at.x, at.y};
        desk.high = {at.x + size.x, at.y + size.y};
        desk.scale = s;
        if (!desk.framed) frameNodes(desk, false);
        ImGui::InvisibleButton(
            "canvas", size,
            ImGuiButtonFlags_MouseButtonLeft | ImGuiButtonFlags_MouseButtonRight | ImGuiButtonFlags_MouseButtonMiddle);
        handleCanvas(work, desk);
        drawCanvas(work, desk);
        contextMenu(work, desk);
        if (desk.textShown) {
            ImGui::SameLine();
            ImGui::BeginChild("graph text", {text, 0}, false, kQuiet);
            graphText(work, desk);
            ImGui::EndChild();
        }
        ImGui::SameLine();
        ImGui::BeginChild("node panel", {0, 0}, false, kQuiet);
        nodePanel(work, desk);
        ImGui::EndChild();
        showNodeList(work, desk);
    }
    ImGui::End();
    ImGui::PopStyleVar();
}

}  // namespace

void handleCanvas(Workspace& work, GraphDesk& desk) {
    const ImGuiIO& io = ImGui::GetIO();
    const bool hovered = ImGui::IsItemHovered();
    const glm::vec2 at = desk.toCanvas(mouseAt());
    if (hovered && io.MouseWheel != 0) zoomBy(desk, io.MouseWheel, mouseAt());
    if (ImGui::IsItemActivated()) {
        if (io.MouseDown[0]) pressLeft(work, desk, at);
        if (io.MouseDown[2] || io.MouseDown[1]) desk.drag = {}, desk.drag.kind = CanvasDrag::pan, desk.drag.from = at;
    }
    auto& drag = desk.drag;
    if (ImGui::IsItemActive()) {
        if (drag.kind == CanvasDrag::pan) desk.pan -= glm::vec2(io.MouseDelta.x, io.MouseDelta.y) / desk.pixels();
        if (drag.kind == CanvasDrag::press && glm::distance(at, drag.from) * desk.pixels() > 4 * desk.scale)
            drag.kind = CanvasDrag::nodes;
        if (drag.kind == CanvasDrag::nodes) moveNodes(desk, at);
    } else if (drag.kind != CanvasDrag::none) {
        const bool right = drag.kind == CanvasDrag::pan && ImGui::IsMouseReleased(1) &&
                           io.MouseDragMaxDistanceSqr[1] < 9 * desk.scale * desk.scale;
        release(work, desk, at);
        if (right) {  // a click: the menu of a node, or the list of kinds
            const auto node = desk.canvas.nodeAt(at);
            if (node && !desk.selected.contains(desk.nameAt(*node))) desk.selected = {desk.nameAt(*node)};
            node ? ImGui::OpenPopup("node menu") : askForNode(desk, at);
        }
    }
    if (hovered) hoverCanvas(work, desk, at);
}

bool takeNodeKey(Workspace& work, const KeyEvent& event) {
    if (!work.editing || !work.graphs.nodes || work.scene().graphs.empty()) return false;
    GraphDesk* desk = graphDesk(work);
    if (!desk || !desk->holds({event.x, event.y})) return false;
    const bool control = event.mods & GLFW_MOD_CONTROL, shift = event.mods & GLFW_MOD_SHIFT;
    const glm::vec2 at = desk->toCanvas({event.x, event.y});
    const int key = event.key;
    const auto is = [&](int wanted, bool withControl, bool withShift) {
        return key == wanted && control == withControl && shift == withShift;
    };
    if (key == GLFW_KEY_ESCAPE && desk->drag.kind != CanvasDrag::none) {
        desk->drag = {};
        desk->canvas.build(desk->model);
    } else if (is(GLFW_KEY_TAB, false, false) || is(GLFW_KEY_A, false, true)) {
        askForNode(*desk, at);
    } else if (is(GLFW_KEY_DELETE, false, false) || is(GLFW_KEY_X, false, false)) {
        removeSelected(work, *desk, false);
    } else if (is(GLFW_KEY_X, true, false)) {
        removeSelected(work, *desk, true);
    } else if (is(GLFW_KEY_C, true, false)) {
        copySelected(work, *desk);
    } else if (is(GLFW_KEY_V, true, false)) {
        const char* text = ImGui::GetClipboardText();
        pasteNodes(work, *desk, text ? text : "", at);
    } else if (is(GLFW_KEY_D, false, true) || is(GLFW_KEY_D, true, false)) {
        duplicateSelected(work, *desk);
    } else if (is(GLFW_KEY_M, false, false)) {
        muteSelected(work, *desk);
    } else if (key == GLFW_KEY_E && !control) {
        if (!desk->selected.empty()) showNode(work, *desk, *desk->selected.begin(), shift);
    } else if (key == GLFW_KEY_A && !control) {
        desk->selected.clear();
        if (!(event.mods & GLFW_MOD_ALT))
            for (const GraphNode& node : desk->model.nodes) desk->selected.insert(node.name);
    } else if (is(GLFW_KEY_HOME, false, false)) {
        frameNodes(*desk, false);
    } else if (is(GLFW_KEY_F, false, false) || is(GLFW_KEY_PERIOD, false, false)) {
        frameNodes(*desk, true);
    } else {
        // Letters by themselves are no tools' here.
        return !control && key >= GLFW_KEY_0 && key <= GLFW_KEY_Z;
    }
    return true;
}

void showGraphs(Workspace& work) {
    GraphDesk* desk = graphDesk(work);
    if (!desk || !work.graphs.nodes) forgetNodeList();
    if (!desk) return;
    const float status = std::ceil(ImGui::GetFrameHeight() + 4 * work.scale);
    const float top = work.viewSize().y - status, bar = kTimeBar * work.scale;
    drawShownPoints(work);
    showTimeBar(work, top);
    if (work.graphs.nodes) layOutDock(work, *desk, top + bar, work.dockUnits() - bar);
}

}  // namespace sample
