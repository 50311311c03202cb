// A graph's nodes -> boxes, ports and wires on the canvas; and what lies at a point of it.
#include <algorithm>
#include <cmath>
#include <map>
#include <unordered_map>

#include "sample_game/graph_parts.hpp"

namespace sample {
namespace {

using espalier::document::findNodeKind;
using espalier::document::GraphGiven;
using espalier::document::GraphModel;
using espalier::document::GraphNode;
using espalier::document::NodeKind;

constexpr float kColumn = 170, kGap = 18;  // of nodes that have no place of their own

float heightOf(const NodeCanvas::Box& box) {
    return NodeCanvas::kTitle + NodeCanvas::kRow * float(box.inputs + box.outputs) + 6;
}

// Columns by the longest way from what nothing leads to; in each, one below the other.
class Columns {
  public:
    Columns(const GraphModel& model, const std::vector<NodeCanvas::Box>& boxes) : model_(model) {
        columns_.assign(model.nodes.size(), -1);
        std::map<int, float> lows;
        for (size_t n = 0; n < model.nodes.size(); ++n) {
            const int column = columnOf(n);
            places_.emplace_back(float(column) * kColumn, lows[column]);
            lows[column] += boxes[n].size.y + kGap;
        }
    }
    glm::vec2 operator[](size_t node) const { return places_[node]; }

  private:
    // Without recursion: chains may be long.
    int columnOf(size_t node) {
        std::vector<size_t> way{node};
        while (!way.empty()) {
            const size_t n = way.back();
            int column = 0;
            bool waits = false;
            for (const GraphGiven& given : model_.nodes[n].inputs) {
                const int from = given.wire() ? model_.find(given.from) : -1;
                if (from < 0) continue;
                if (columns_[size_t(from)] < 0 && way.size() <= model_.nodes.size()) {
                    way.push_back(size_t(from));
                    waits = true;
                    break;
                }
                column = std::max(column, columns_[size_t(from)] + 1);
            }
            if (waits) continue;
            columns_[n] = column;
            way.pop_back();
        }
        return columns_[node];
    }

    const GraphModel& model_;
    std::vector<int> columns_;
    std::vector<glm::vec2> places_;
};

// Nodes without a place: as columns, below those that have one.
void placeOthers(const GraphModel& model, std::vector<NodeCanvas::Box>& boxes) {
    std::vector<size_t> others;
    float low = 0;
    for (size_t n = 0; n < boxes.size(); ++n) {
        if (const auto place = model.placeOf(model.nodes[n].name)) {
            boxes[n].at = {(*place)[0], (*place)[1]};
            low = std::max(low, boxes[n].at.y + boxes[n].size.y + kGap);
        } else {
            others.push_back(n);
        }
    }
    if (others.empty()) return;
    const Columns columns(model, boxes);
    for (const size_t n : others) boxes[n].at = columns[n] + glm::vec2(0, low);
}

float distanceToWire(glm::vec2 p, glm::vec2 a, glm::vec2 d) {
    const float bend = NodeCanvas::bend(a, d);
    const glm::vec2 b = a + glm::vec2(bend, 0), c = d - glm::vec2(bend, 0);
    constexpr int kSteps = 24;
    float nearest = 1e30f;
    glm::vec2 before = a;
    for (int i = 1; i <= kSteps; ++i) {
        const float t = float(i) / kSteps, u = 1 - t;
        const glm::vec2 now = u * u * u * a + 3 * u * u * t * b + 3 * u * t * t * c + t * t * t * d;
        const glm::vec2 along = now - before;
        const float part = std::clamp(glm::dot(p - before, along) / std::max(glm::dot(along, along), 1e-6f), 0.f, 1.f);
        nearest = std::min(nearest, glm::distance(p, before + part * along));
        before = now;
    }
    return nearest;
}

}  // namespace

float NodeCanvas::bend(glm::vec2 from, glm::vec2 to) {
    return std::clamp(.5f * std::abs(to.x - from.x), 24.f, 120.f);
}

void NodeCanvas::build(const GraphModel& model) {
    boxes.assign(model.nodes.size(), {});
    wires.clear();
    for (size_t n = 0; n < model.nodes.size(); ++n) {
        const GraphNode& node = model.nodes[n];
        Box& box = boxes[n];
        box.kind = findNodeKind(node.kind);
        box.inputs = uint32_t(box.kind ? box.kind->inputs.size() : node.inputs.size());
        box.outputs = uint32_t(box.kind ? box.kind->outputs.size() : 1);
        box.size = {kWidth, heightOf(box)};
    }
    placeOthers(model, boxes);
    for (uint32_t n = 0; n < model.nodes.size(); ++n) {
        std::unordered_map<int, uint32_t> places;
        for (size_t i = 0; i < model.nodes[n].inputs.size(); ++i) {
            const GraphGiven& given = model.nodes[n].inputs[i];
            const int input = boxes[n].kind ? boxes[n].kind->input(given.input) : int(i);
            const uint32_t place = places[input]++;
            const int from = given.wire() ? model.find(given.from) : -1;
            if (from < 0 || input < 0) continue;
            const NodeKind* kind = boxes[size_t(from)].kind;
            const int output = kind ? std::max(0, kind->output(given.output)) : 0;
            wires.push_back({{uint32_t(from), uint32_t(output), true}, {n, uint32_t(input), false}, place});
        }
    }
}

glm::vec2 NodeCanvas::placeOf(const Port& port) const {
    const Box& box = boxes[port.node];
    const float row = float(port.output ? port.index : box.outputs + port.index);
    return box.at + glm::vec2(port.output ? box.size.x : 0, kTitle + kRow * (row + .5f));
}

std::optional<uint32_t> NodeCanvas::nodeAt(glm::vec2 p) const {
    for (size_t n = boxes.size(); n-- > 0;)
        if (boxes[n].contains(p)) return uint32_t(n);
    return {};
}

std::optional<NodeCanvas::Port> NodeCanvas::portNear(glm::vec2 p, float reach) const {
    std::optional<Port> nearest;
    const auto consider = [&](const Port& port) {
        const float distance = glm::distance(placeOf(port), p);
        if (distance > reach) return;
        reach = distance;
        nearest = port;
    };
    for (uint32_t n = 0; n < boxes.size(); ++n) {
        if (!boxes[n].contains(p, reach)) continue;
        for (uint32_t i = 0; i < boxes[n].inputs; ++i) consider({n, i, false});
        for (uint32_t o = 0; o < boxes[n].outputs; ++o) consider({n, o, true});
    }
    return nearest;
}

std::optional<size_t> NodeCanvas::wireNear(glm::vec2 p, float reach) const {
    std::optional<size_t> nearest;
    for (size_t w = 0; w < wires.size(); ++w) {
        const glm::vec2 a = placeOf(wires[w].from), b = placeOf(wires[w].to);
        const float around = bend(a, b) + reach;
        if (p.x < std::min(a.x, b.x) - around || p.x > std::max(a.x, b.x) + around ||
            p.y < std::min(a.y, b.y) - reach || p.y > std::max(a.y, b.y) + reach)
            continue;
        const float distance = distanceToWire(p, a, b);
        if (distance <= reach) reach = distance, nearest = w;
    }
    return nearest;
}

// ---- The desk

GraphDesk* graphDesk(Workspace& work) {
    static GraphDesk desk;
    const auto& graphs = work.scene().graphs;
    if (graphs.empty()) {
        desk = {};
        return nullptr;
    }
    work.graphs.open = std::min(work.graphs.open, uint32_t(graphs.size() - 1));
    const EspGraph id = graphs[work.graphs.open].id;
    if (desk.document != work.document.get() || desk.graph != work.graphs.open || desk.id != id.id) {
        desk = {};
        desk.document = work.document.get();
        desk.graph = work.graphs.open;
        desk.id = id.id;
        (void)espMeasureGraph(work.context.get(), id, 1);
    }
    const auto& graph = graphs[desk.graph];
    if (desk.text == graph.runs) return &desk;
    desk.text = graph.runs;
    std::string ignored;
    if (!desk.model.read(work.context.get(), desk.text, graph.file, ignored)) desk.model = {};
    desk.canvas.build(desk.model);
    std::erase_if(desk.selected, [](const std::string& name) { return desk.model.find(name) < 0; });
    return &desk;
}

std::string GraphDesk::wireText(const NodeCanvas::Port& output) const {
    const NodeCanvas::Box& box = canvas.boxes[output.node];
    const std::string& name = nameAt(output.node);
    return !box.kind || output.index == 0 ? name : name + "." + box.kind->outputs[output.index].name;
}

std::string GraphDesk::inputName(const NodeCanvas::Port& input) const {
    const NodeCanvas::Box& box = canvas.boxes[input.node];
    return box.kind ? box.kind->inputs[input.index].name : nodeAt(input.node).inputs[input.index].input;
}

std::optional<EspNodeType> GraphDesk::typeOf(const NodeCanvas::Port& port) const {
    const NodeCanvas::Box& box = canvas.boxes[port.node];
    if (!box.kind) return {};
    if (!port.output) return box.kind->inputs[port.index].type;
    return model.typeOf(nameAt(port.node), box.kind->outputs[port.index].name);
}

bool GraphDesk::fits(const NodeCanvas::Port& output, const NodeCanvas::Port& input, std::string& why) const {
    const std::vector<std::string> way = model.way(nameAt(input.node), nameAt(output.node));
    if (!way.empty()) {
        why = "That would go round in a circle: ";
        for (const std::string& name : way) why += name + " \u2192 ";
        why += way.front();
        return false;
    }
    const NodeCanvas::Box& box = canvas.boxes[input.node];
    if (box.kind && !box.kind->inputs[input.index].opener.empty()) {
        const std::string& opener = box.kind->inputs[input.index].opener;
        if (nodeAt(output.node).kind != opener) why = "'" + inputName(input) + "' takes a wire to " + opener;
        return why.empty();
    }
    const auto given = typeOf(output), taken = typeOf(input);
    if (!taken || (given && !espNodeTypeTakes(*taken, *given))) {
        why = !taken ? "'" + nodeAt(input.node).kind + "' isn't known: nothing can be wired to it"
                     : "'" + inputName(input) + "' takes " + espNodeTypeName(*taken) + ", this is " +
                           espNodeTypeName(*given);
        return false;
    }
    return true;
}

}  // namespace sample
