// Edits of graphs. Each reads the text as nodes, changes these and writes them; the plugin decides whether that is a
// graph, and keeps what nodes have made that are made from the same as before. What takes an edit back is the text
// before it, byte for byte.
#include <algorithm>
#include <cmath>
#include <unordered_set>

#include "tools/document/document.hpp"

namespace espalier::document {
namespace {

bool has(const std::vector<std::string>& list, const std::string& name) {
    return std::ranges::find(list, name) != list.end();
}

GraphNode* nodeOf(GraphModel& model, const std::string& name, std::string& error) {
    const int n = model.find(name);
    if (n < 0) error = "there is no node '" + name + "'";
    return n < 0 ? nullptr : &model.nodes[size_t(n)];
}

bool areThere(const GraphModel& model, const std::vector<std::string>& names, std::string& error) {
    const auto missing = std::ranges::find_if(names, [&](const std::string& name) { return model.find(name) < 0; });
    if (missing != names.end()) error = "there is no node '" + *missing + "'";
    return missing == names.end();
}

// One value or wire by itself, as a text has it.
bool readGiven(EspContext* context, const std::string& text, GraphGiven& out, std::string& error) {
    GraphModel model;
    if (text.find('\n') == std::string::npos &&
        model.read(context, "graph 1\nvalue = Any(" + text + ")\n", "value", error) && model.nodes.size() == 1 &&
        model.nodes[0].inputs.size() == 1 && model.nodes[0].inputs[0].input.empty()) {
        out = model.nodes[0].inputs[0];
        return true;
    }
    error = "'" + text + "' is no value of a node's input";
    return false;
}

bool isWired(const GraphNode& node, const std::string& input) {
    const GraphGiven* given = node.given(input);
    return given && given->wire();
}

// What the node's first input is wired to takes its place; where nothing is, or that doesn't fit, the wire goes.
void bridge(GraphModel& model, GraphGiven& given) {
    const int n = model.find(given.from);
    const GraphNode& gone = model.nodes[size_t(n)];
    const NodeKind* kind = findNodeKind(gone.kind);
    const GraphGiven* first = kind && !kind->inputs.empty() ? gone.given(kind->inputs[0].name) : nullptr;
    if (!first || !first->wire()) return;
    given.from = first->from;
    given.output = first->output;
}

void dropWires(GraphModel& model, const std::unordered_set<std::string>& gone, bool bridges) {
    for (GraphNode& node : model.nodes) {
        if (gone.contains(node.name)) continue;
        const NodeKind* kind = findNodeKind(node.kind);
        for (GraphGiven& given : node.inputs)
            for (size_t steps = 0; bridges && given.wire() && gone.contains(given.from) && steps < gone.size(); ++steps)
                bridge(model, given);
        std::erase_if(node.inputs, [&](const GraphGiven& given) {
            if (!given.wire()) return false;
            if (gone.contains(given.from)) return true;
            const int port = kind && bridges ? kind->input(given.input) : -1;
            const auto type = port < 0 ? std::nullopt : model.typeOf(given.from, given.output);
            return type && !espNodeTypeTakes(kind->inputs[size_t(port)].type, *type);
        });
    }
}

}  // namespace

bool Document::editGraph(uint32_t index, std::vector<Action>& back, std::string& error, const GraphEdit& edit) {
    if (index >= scene_.graphs.size()) {
        error = "there is no graph " + std::to_string(index);
        return false;
    }
    scene::LoadedGraph& graph = scene_.graphs[index];
    if (!graph.error.empty()) {
        error = "the graph's text has mistakes, which come first: " + graph.error;
        return false;
    }
    GraphModel model;
    if (!model.read(context_, graph.text, graph.file, error) || !edit(model, error)) return false;
    scene::LoadedGraph edited = graph;
    if (!setText(context_, edited, model.write())) {
        error = edited.error;
        return false;
    }
    edited.text = edited.runs = espGraphText(context_, graph.id);  // in the one way in which graphs are written
    back.push_back(SetGraphText{index, graph.text, {}});
    graph = std::move(edited);
    return true;
}

bool Document::carryOut(const SetGraphText& action, std::vector<Action>& back, std::string& error) {
    if (action.graph >= scene_.graphs.size()) {
        error = "there is no graph " + std::to_string(action.graph);
        return false;
    }
    scene::LoadedGraph& graph = scene_.graphs[action.graph];
    back.push_back(SetGraphText{action.graph, graph.text, graph.text == graph.runs ? "" : graph.runs});
    if (!action.runs.empty() && action.runs != graph.runs) (void)setText(context_, graph, action.runs);
    (void)setText(context_, graph, action.text);
    return true;
}

bool Document::carryOut(const AddNodes& action, std::vector<Action>& back, std::string& error) {
    return editGraph(action.graph, back, error, [&](GraphModel& model, std::string& why) {
        GraphModel added;
        if (!added.read(context_, action.text, "nodes", why)) return false;
        if (added.nodes.empty()) why = "there are no nodes to add";
        for (const GraphNode& node : added.nodes)
            if (model.find(node.name) >= 0) why = "another node is called '" + node.name + "' already";
        if (!why.empty()) return false;
        model.nodes.insert(model.nodes.end(), added.nodes.begin(), added.nodes.end());
        model.muted.insert(model.muted.end(), added.muted.begin(), added.muted.end());
        for (const auto& [name, at] : added.layout) model.place(name, at);
        return true;
    });
}

bool Document::carryOut(const RemoveNodes& action, std::vector<Action>& back, std::string& error) {
    return editGraph(action.graph, back, error, [&](GraphModel& model, std::string& why) {
        if (!areThere(model, action.nodes, why)) return false;
        const std::unordered_set<std::string> gone(action.nodes.begin(), action.nodes.end());
        dropWires(model, gone, action.bridge);
        std::erase_if(model.nodes, [&](const GraphNode& node) { return gone.contains(node.name); });
        for (auto* list : {&model.shown, &model.muted})
            std::erase_if(*list, [&](const std::string& name) { return gone.contains(name); });
        std::erase_if(model.layout, [&](const auto& entry) { return gone.contains(entry.first); });
        return true;
    });
}

bool Document::carryOut(const SetNodeInput& action, std::vector<Action>& back, std::string& error) {
    return editGraph(action.graph, back, error, [&](GraphModel& model, std::string& why) {
        GraphNode* node = nodeOf(model, action.node, why);
        GraphGiven given;
        if (!node || (!action.value.empty() && !readGiven(context_, action.value, given, why))) return false;
        if (given.wire()) {
            why = "'" + action.value + "' is a wire, which is connected by itself";
            return false;
        }
        given.input = action.input;
        std::erase_if(node->inputs, [&](const GraphGiven& before) { return before.input == action.input; });
        if (!action.value.empty()) node->inputs.push_back(std::move(given));
        return true;
    });
}

bool Document::carryOut(const ConnectNodes& action, std::vector<Action>& back, std::string& error) {
    return editGraph(action.graph, back, error, [&](GraphModel& model, std::string& why) {
        GraphNode* node = nodeOf(model, action.node, why);
        GraphGiven given;
        if (!node || (!action.wire.empty() && !readGiven(context_, action.wire, given, why))) return false;
        if (!action.wire.empty() && !given.wire()) {
            why = "'" + action.wire + "' is no node's output";
            return false;
        }
        given.input = action.input;
        const NodeKind* kind = findNodeKind(node->kind);
        const int port = kind ? kind->input(action.input) : -1;
        const bool many = port >= 0 && kind->inputs[size_t(port)].many;
        if (action.wire.empty() && !isWired(*node, action.input)) {
            why = "nothing is wired there";
            return false;
        }
        // Which of those at the input is meant.
        std::vector<size_t> there;
        for (size_t i = 0; i < node->inputs.size(); ++i)
            if (node->inputs[i].input == action.input) there.push_back(i);
        if (many && action.place < there.size()) {
            const auto at = node->inputs.begin() + std::ptrdiff_t(there[action.place]);
            if (action.wire.empty())
                node->inputs.erase(at);
            else
                *at = std::move(given);
            return true;
        }
        const bool more = many && !action.wire.empty();  // constants give way to wires
        std::erase_if(node->inputs, [&](const GraphGiven& before) {
            return before.input == action.input && !(more && before.wire());
        });
        if (!action.wire.empty()) node->inputs.push_back(std::move(given));
        return true;
    });
}

bool Document::carryOut(const MoveNodes& action, std::vector<Action>& back, std::string& error) {
    return editGraph(action.graph, back, error, [&](GraphModel& model, std::string& why) {
        if (!areThere(model, action.nodes, why)) return false;
        if (action.nodes.size() != action.places.size()) {
            why = "each node needs a place";
            return false;
        }
        for (size_t i = 0; i < action.nodes.size(); ++i) {
            if (!std::isfinite(action.places[i][0]) || !std::isfinite(action.places[i][1])) {
                why = "the place of '" + action.nodes[i] + "' isn't finite";
                return false;
            }
            model.place(action.nodes[i], action.places[i]);
        }
        return true;
    });
}

bool Document::carryOut(const RenameNode& action, std::vector<Action>& back, std::string& error) {
    return editGraph(action.graph, back, error, [&](GraphModel& model, std::string& why) {
        GraphNode* node = nodeOf(model, action.node, why);
        if (!node) return false;
        if (!isNodeName(action.name))
            why = "'" + action.name + "' is no name: letters, digits and _ are, no digit first";
        if (model.find(action.name) >= 0) why = "another node is called '" + action.name + "' already";
        if (!why.empty()) return false;
        node->name = action.name;
        for (GraphNode& reader : model.nodes)
            for (GraphGiven& given : reader.inputs)
                if (given.wire() && given.from == action.node) given.from = action.name;
        for (auto* list : {&model.shown, &model.muted}) std::ranges::replace(*list, action.node, action.name);
        for (auto& [name, at] : model.layout)
            if (name == action.node) name = action.name;
        return true;
    });
}

bool Document::carryOut(const ShowNodes& action, std::vector<Action>& back, std::string& error) {
    return editGraph(action.graph, back, error, [&](GraphModel& model, std::string& why) {
        if (!areThere(model, action.nodes, why)) return false;
        model.shown = action.nodes;
        return true;
    });
}

bool Document::carryOut(const MuteNodes& action, std::vector<Action>& back, std::string& error) {
    return editGraph(action.graph, back, error, [&](GraphModel& model, std::string& why) {
        if (!areThere(model, action.nodes, why)) return false;
        std::erase_if(model.muted, [&](const std::string& name) { return has(action.nodes, name); });
        if (action.muted) model.muted.insert(model.muted.end(), action.nodes.begin(), action.nodes.end());
        return true;
    });
}

bool Document::carryOut(const SetGraphTime& action, std::vector<Action>&, std::string& error) {
    if (action.frame > scene::kMostGraphFrame || !(action.rate >= 1 && action.rate <= scene::kMostGraphRate)) {
        error = "a frame is 0 to 16777216, and there are 1 to 1000 a second";
        return false;
    }
    return setGraphTime(context_, scene_, action.frame, action.rate, error);
}

}  // namespace espalier::document
