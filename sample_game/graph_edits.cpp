// What the node editor asks of the document: nodes and wires that come and go.
#include <imgui.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <map>

#include "sample_game/graph_parts.hpp"
#include "sample_game/panels.hpp"

namespace sample {
namespace {

using namespace espalier::document;
using Port = NodeCanvas::Port;

// As a text of its own, with what places and mutes it.
GraphModel partOf(const GraphModel& model, const std::set<std::string>& names) {
    GraphModel part;
    for (const GraphNode& node : model.nodes) {
        if (!names.contains(node.name)) continue;
        part.nodes.push_back(node);
        if (model.isMuted(node.name)) part.muted.push_back(node.name);
        if (const auto place = model.placeOf(node.name)) part.layout.emplace_back(node.name, *place);
    }
    part.index();
    return part;
}

void rename(GraphModel& model, const std::map<std::string, std::string>& names) {
    const auto name = [&](std::string& old) {
        if (const auto found = names.find(old); found != names.end()) old = found->second;
    };
    for (GraphNode& node : model.nodes) {
        name(node.name);
        for (GraphGiven& given : node.inputs)
            if (given.wire()) name(given.from);
    }
    for (std::string& muted : model.muted) name(muted);
    for (auto& [placed, at] : model.layout) name(placed);
    model.index();
}

// Nodes come in with names that are new, moved by so much, and are selected. Wires to nodes that aren't there go.
bool addAll(Workspace& work, GraphDesk& desk, GraphModel part, glm::vec2 move) {
    std::map<std::string, std::string> names;
    GraphModel all = desk.model;
    for (const GraphNode& node : part.nodes) {
        names[node.name] = all.freshName(node.name);
        all.nodes.push_back({names[node.name], node.kind, {}, {}, 0});
        all.index();
    }
    for (GraphNode& node : part.nodes)
        std::erase_if(node.inputs, [&](const GraphGiven& given) {
            return given.wire() && !names.contains(given.from) && desk.model.find(given.from) < 0;
        });
    rename(part, names);
    part.shown.clear();
    for (auto& [name, at] : part.layout) at = {std::round(at[0] + move.x), std::round(at[1] + move.y)};
    if (!work.perform(AddNodes{desk.graph, part.write()}, work.newGesture())) return false;
    desk.selected.clear();
    for (const auto& [old, now] : names) desk.selected.insert(now);
    return true;
}

std::string smallName(std::string kind) {
    for (char& c : kind) c = char(std::tolower(static_cast<unsigned char>(c)));
    return kind;
}

// The first input that needs a wire and that the type fits; else, if any will do, one that is called as what gives it,
// such as 'time', or the first that it fits.
std::optional<uint32_t> inputFor(const NodeKind& kind, std::optional<EspNodeType> given, const std::string& giver,
                                 bool any) {
    for (const bool needed : {true, false}) {
        if (!needed && !any) break;
        for (uint32_t i = 0; i < kind.inputs.size(); ++i) {
            const NodePort& port = kind.inputs[i];
            if (needed && !port.wired && (!any || port.name != giver)) continue;
            if (!port.opener.empty() && smallName(port.opener) != giver) continue;
            if (!port.opener.empty()) return i;
            if (!given || espNodeTypeTakes(port.type, *given)) return i;
        }
    }
    return {};
}

std::string wireOf(const NodeKind& kind, const std::string& name, EspNodeType wanted) {
    for (size_t o = 0; o < kind.outputs.size(); ++o)
        if (espNodeTypeTakes(wanted, kind.outputs[o].type) || kind.outputs[o].asFirst)
            return o == 0 ? name : name + "." + kind.outputs[o].name;
    return "";
}

// A new node is wired to the port that was dragged, or to the node that is selected, where one needs the other.
void wireNew(Workspace& work, const GraphDesk& desk, const NodeKind& kind, const std::string& name,
             const std::optional<Port>& port, uint32_t gesture) {
    if (port && port->output) {
        if (const auto input = inputFor(kind, desk.typeOf(*port), smallName(desk.nodeAt(port->node).kind), true))
            work.perform(ConnectNodes{desk.graph, name, kind.inputs[*input].name, desk.wireText(*port)}, gesture);
        return;
    }
    if (port) {
        const auto type = desk.typeOf(*port);
        const std::string wire = type ? wireOf(kind, name, *type) : "";
        if (!wire.empty())
            work.perform(ConnectNodes{desk.graph, desk.nameAt(port->node), desk.inputName(*port), wire}, gesture);
        return;
    }
    if (desk.selected.size() != 1) return;
    const int n = desk.model.find(*desk.selected.begin());
    const NodeKind* before = n < 0 ? nullptr : desk.canvas.boxes[size_t(n)].kind;
    if (!before) return;
    const Port output{uint32_t(n), 0, true};
    const auto given = before->outputs.empty() ? std::nullopt : desk.typeOf(output);
    const auto takes = given ? inputFor(kind, given, "", false) : std::nullopt;
    if (takes) {
        work.perform(ConnectNodes{desk.graph, name, kind.inputs[*takes].name, desk.wireText(output)}, gesture);
        return;
    }
    const GraphNode& node = desk.model.nodes[size_t(n)];
    for (const NodePort& input : before->inputs) {
        const GraphGiven* there = node.given(input.name);
        if (!input.wired || !input.opener.empty() || (there && there->wire() && !input.many)) continue;
        const std::string wire = wireOf(kind, name, input.type);
        if (wire.empty()) continue;
        work.perform(ConnectNodes{desk.graph, node.name, input.name, wire}, gesture);
        return;
    }
}

// Where a node may stand that is to lie there: lower, if others are in its way.
glm::vec2 freePlace(const NodeCanvas& canvas, const NodeKind& kind, glm::vec2 at) {
    const float high = NodeCanvas::kTitle + NodeCanvas::kRow * float(kind.inputs.size() + kind.outputs.size()) + 6;
    for (int tries = 0; tries < 100; ++tries) {
        const auto in = std::ranges::find_if(canvas.boxes, [&](const NodeCanvas::Box& box) {
            return at.x < box.at.x + box.size.x + 8 && at.x + NodeCanvas::kWidth + 8 > box.at.x &&
                   at.y < box.at.y + box.size.y + 8 && at.y + high + 8 > box.at.y;
        });
        if (in == canvas.boxes.end()) break;
        at.y = in->at.y + in->size.y + 14;
    }
    return glm::round(at);
}

}  // namespace

void addNode(Workspace& work, GraphDesk& desk, const NodeKind& kind) {
    const auto port = desk.list.port;
    // Keyed in, it comes behind the node that is selected; dragged or asked for elsewhere, where the mouse is.
    glm::vec2 at = desk.list.at;
    if (port) at += glm::vec2(port->output ? 10 : -NodeCanvas::kWidth - 10, -NodeCanvas::kTitle);
    const int before = !port && desk.selected.size() == 1 ? desk.model.find(*desk.selected.begin()) : -1;
    if (before >= 0) {
        const NodeCanvas::Box& box = desk.canvas.boxes[size_t(before)];
        at = box.at + glm::vec2(box.size.x + 30, 0);
    }
    at = freePlace(desk.canvas, kind, at);
    const std::string name = desk.model.freshName(kind.name);
    GraphModel added;
    added.nodes.push_back({name, kind.name, {}, {}, 0});
    added.layout.push_back({name, {at.x, at.y}});
    const uint32_t gesture = work.newGesture();
    if (!work.perform(AddNodes{desk.graph, added.write()}, gesture)) return;
    wireNew(work, desk, kind, name, port, gesture);
    work.document->callStep(gesture, "Add " + kind.name);
    desk.selected = {name};
}

// output: of no node, the wire `instead` goes. instead: the wire whose place this takes.
void connect(Workspace& work, const GraphDesk& desk, const Port& output, const Port& input,
             const std::optional<NodeCanvas::Wire>& instead, uint32_t gesture) {
    ConnectNodes wire{desk.graph, desk.nameAt(input.node), desk.inputName(input), "", ConnectNodes::kLast};
    if (output.output) wire.wire = desk.wireText(output);
    if (instead) wire.place = instead->place;
    work.perform(wire, gesture);
}

void removeSelected(Workspace& work, GraphDesk& desk, bool bridge) {
    if (desk.selected.empty()) return;
    work.perform(RemoveNodes{desk.graph, {desk.selected.begin(), desk.selected.end()}, bridge}, work.newGesture());
}

void copySelected(const Workspace&, const GraphDesk& desk) {
    if (!desk.selected.empty()) ImGui::SetClipboardText(partOf(desk.model, desk.selected).write().c_str());
}

void pasteNodes(Workspace& work, GraphDesk& desk, const std::string& text, glm::vec2 at) {
    GraphModel part;
    std::string why;
    // Lines of a graph without its head are meant as well.
    if (!part.read(work.context.get(), text, "clipboard", why) &&
        !part.read(work.context.get(), "graph 1\n" + text, "clipboard", why)) {
        work.error = "What was copied is no graph: " + why;
        return;
    }
    if (part.nodes.empty()) return work.say("Nothing was copied that could be pasted here");
    NodeCanvas laid;
    laid.build(part);
    glm::vec2 low(1e30f);
    for (size_t n = 0; n < laid.boxes.size(); ++n) {
        low = glm::min(low, laid.boxes[n].at);
        part.place(part.nodes[n].name, {laid.boxes[n].at.x, laid.boxes[n].at.y});
    }
    addAll(work, desk, std::move(part), at - low);
}

void duplicateSelected(Workspace& work, GraphDesk& desk) {
    if (desk.selected.empty()) return;
    GraphModel part = partOf(desk.model, desk.selected);
    for (const std::string& name : desk.selected) {
        const glm::vec2 at = desk.canvas.boxes[size_t(desk.model.find(name))].at;
        part.place(name, {at.x, at.y});
    }
    addAll(work, desk, std::move(part), {24, 24});
}

void muteSelected(Workspace& work, GraphDesk& desk) {
    if (desk.selected.empty()) return;
    const auto muted = [&](const std::string& name) { return desk.model.isMuted(name); };
    const bool all = std::ranges::all_of(desk.selected, muted);
    work.perform(MuteNodes{desk.graph, {desk.selected.begin(), desk.selected.end()}, !all}, work.newGesture());
}

void showNode(Workspace& work, const GraphDesk& desk, const std::string& node, bool more) {
    ShowNodes show{desk.graph, {node}};
    if (more) {
        show.nodes = desk.model.shown;
        if (std::erase(show.nodes, node) == 0) show.nodes.push_back(node);
    } else if (desk.model.shown == show.nodes) {
        return;
    }
    work.perform(show, work.newGesture());
}

void frameNodes(GraphDesk& desk, bool selectedOnly) {
    glm::vec2 low(1e30f), high(-1e30f);
    for (uint32_t n = 0; n < desk.canvas.boxes.size(); ++n) {
        if (selectedOnly && !desk.selected.empty() && !desk.selected.contains(desk.nameAt(n))) continue;
        const NodeCanvas::Box& box = desk.canvas.boxes[n];
        low = glm::min(low, box.at);
        high = glm::max(high, box.at + box.size);
    }
    desk.framed = true;
    if (low.x > high.x) low = glm::vec2(0), high = glm::vec2(400, 200);
    const glm::vec2 room = (desk.high - desk.low) / desk.scale, size = high - low + glm::vec2(40);
    desk.zoom = std::clamp(std::min(room.x / size.x, room.y / size.y), .1f, 1.1f);
    desk.pan = .5f * (low + high) - .5f * room / desk.zoom;
}

EspNodeState nodeState(const Workspace& work, const std::string& node) {
    EspNodeState state{};
    const EspGraph graph = work.scene().graphs[work.graphs.open].id;
    if (espNodeStateOf(work.context.get(), graph, node.c_str(), nullptr, &state) != ESP_OK)
        state.failure = state.note = nullptr;
    return state;
}

std::string countText(uint64_t count) {
    std::string text = std::to_string(count);
    for (int at = int(text.size()) - 3; at > 0; at -= 3) text.insert(size_t(at), ",");
    return text;
}

std::string stateText(const EspNodeState& state) {
    if (!state.made) return "";
    GraphGiven value;
    std::copy(std::begin(state.numbers), std::end(state.numbers), value.numbers.begin());
    value.kind = state.type == ESP_NODE_NUMBER ? ESP_GRAPH_NUMBER : ESP_GRAPH_VECTOR;
    if (state.type == ESP_NODE_NUMBER || state.type == ESP_NODE_VECTOR) return valueText(value);
    if (state.type == ESP_NODE_MATERIAL) return "Colour " + valueText(value);
    std::string text;
    const auto add = [&](uint64_t count, const char* what) {
        if (count > 0) text += (text.empty() ? "" : ", ") + countText(count) + what;
    };
    add(state.points, " points");
    add(state.curves, " curves");
    add(state.vertices, " vertices");
    add(state.triangles, " triangles");
    if (state.instances > state.parts) add(state.instances, " instances");
    return text.empty() ? "Nothing" : text;
}

}  // namespace sample
