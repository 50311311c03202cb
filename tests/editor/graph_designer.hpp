#pragma once

#include <algorithm>
#include <random>
#include <set>

#include "tests/editor/editing.hpp"

namespace espalier::document {

// Who edits a graph by chance: nodes, wires, values, names. What the plugin refuses, such as a circle, is part of it.
class GraphDesigner {
  public:
    GraphDesigner(Document& document, uint32_t seed) : document_(document), random_(seed) {}

    static constexpr size_t kEdits = 9;
    Action any(uint32_t graph) { return of(graph, pick(kEdits)); }
    Action of(uint32_t graph, size_t edit) {
        read(graph);
        if (model_.nodes.size() < 3) edit = 0;
        switch (edit) {
            case 0:
                return add(graph);
            case 1:
                return RemoveNodes{graph, someNodes(), pick(2) == 0};
            case 2:
                return input(graph);
            case 3:
            case 4:
                return connect(graph);
            case 5:
                return move(graph);
            case 6:
                return RenameNode{graph, anyNode().name, "n" + std::to_string(pick(1000))};
            case 7:
                return ShowNodes{graph, someNodes()};
            default:
                return MuteNodes{graph, someNodes(), pick(2) == 0};
        }
    }
    Action add(uint32_t graph) {
        read(graph);
        GraphModel added;
        for (size_t i = 0, count = 1 + pick(2); i < count; ++i) {
            const NodeKind& kind = nodeKinds()[pick(nodeKinds().size())];
            const std::string name = model_.freshName(kind.name);
            added.nodes.push_back({name, kind.name, {}, {}, 0});
            if (pick(3) == 0) added.nodes.back().comments = "a note";
            if (pick(3)) added.layout.push_back({name, {chance(), chance()}});
            model_.nodes.push_back(added.nodes.back());
            model_.index();
        }
        return AddNodes{graph, added.write()};
    }

  private:
    size_t pick(size_t count) { return random_() % std::max<size_t>(count, 1); }
    float chance() { return std::uniform_real_distribution<float>(-500, 500)(random_); }
    void read(uint32_t graph) {
        std::string error;
        REQUIRE_MESSAGE(model_.read(document_.context(), document_.scene().graphs[graph].text, "graph", error), error);
    }
    const GraphNode& anyNode() { return model_.nodes[pick(model_.nodes.size())]; }
    std::vector<std::string> someNodes() {
        std::set<std::string> names{anyNode().name};
        if (pick(3) == 0) names.insert(anyNode().name);
        return {names.begin(), names.end()};
    }
    Action input(uint32_t graph) {
        const GraphNode& node = anyNode();
        const NodeKind* kind = findNodeKind(node.kind);
        if (!kind || kind->inputs.empty()) return MoveNodes{graph, {node.name}, {{1, 2}}};
        const NodePort& port = kind->inputs[pick(kind->inputs.size())];
        GraphGiven value;
        value.kind = numbersOf(port.type) == 3 ? ESP_GRAPH_VECTOR
                     : isText(port.type)       ? ESP_GRAPH_TEXT
                                               : ESP_GRAPH_NUMBER;
        for (float& number : value.numbers)
            number = std::clamp(port.type == ESP_NODE_WHOLE ? float(pick(40)) : chance(), port.low, port.high);
        value.text = port.words.empty() ? "a \"quoted\" word" : port.words[pick(port.words.size())];
        return SetNodeInput{graph, node.name, port.name, pick(4) ? valueText(value) : ""};
    }
    Action connect(uint32_t graph) {
        const GraphNode &from = anyNode(), &to = anyNode();
        const NodeKind *gives = findNodeKind(from.kind), *takes = findNodeKind(to.kind);
        if (!gives || !takes || takes->inputs.empty() || gives->outputs.empty()) return add(graph);
        const size_t output = pick(gives->outputs.size());
        const std::string wire = output == 0 ? from.name : from.name + "." + gives->outputs[output].name;
        return ConnectNodes{graph, to.name, takes->inputs[pick(takes->inputs.size())].name, pick(6) ? wire : "",
                            pick(2) ? ConnectNodes::kLast : uint32_t(pick(2))};
    }
    Action move(uint32_t graph) {
        MoveNodes move{graph, someNodes(), {}};
        for (size_t i = 0; i < move.nodes.size(); ++i) move.places.push_back({chance(), chance()});
        return move;
    }

    Document& document_;
    std::mt19937 random_;
    GraphModel model_;
};

}  // namespace espalier::document
