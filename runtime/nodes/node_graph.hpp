#pragma once

// A procedural graph as its text has it: what there is, not what comes of it. docs/graph.md describes the text.

#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "runtime/nodes/kinds.hpp"

namespace espalier {

struct TextPlace {
    int line = 0, column = 0;                                 // from 1; 0: it stands in no text
    bool operator==(const TextPlace&) const { return true; }  // graphs are compared by what they say
};

// A constant, or a wire to an output of another node.
struct NodeInput {
    std::string port;          // "": of a kind that isn't known, given by its place
    Literal constant;          // kind none: it is a wire
    std::string from, output;  // the node; its output, or "" for the first
    TextPlace place = {};
    bool operator==(const NodeInput&) const = default;
};

struct GraphNode {
    std::string name, kind;
    std::vector<NodeInput> inputs;      // of a known kind in the order of its ports
    std::vector<std::string> comments;  // lines before it
    TextPlace place = {};
    bool operator==(const GraphNode&) const = default;
};

struct NodeGraph {
    static constexpr int kVersion = 1;
    static constexpr size_t kMostNodes = 100000, kMostLoops = 256;
    std::string file;  // for messages
    std::vector<GraphNode> nodes;
    std::vector<std::pair<std::string, TextPlace>> shown;
    std::vector<std::pair<std::string, TextPlace>> muted;   // they give what is wired to their first input
    std::vector<std::pair<std::string, glm::vec3>> layout;  // x and y of a node on the canvas
    std::vector<std::string> comments;                      // behind all nodes

    bool operator==(const NodeGraph& other) const {
        return nodes == other.nodes && shown == other.shown && muted == other.muted && layout == other.layout &&
               comments == other.comments;
    }
    int find(std::string_view name) const;  // -1: there is none. Takes time; who looks for many makes an index
};

// Reads a text. Fails with every mistake of the form "file:line:column: node: message". Kinds that aren't known stay as
// they are written.
Result<NodeGraph> parseGraph(std::string_view text, const std::string& file);
// The one way to write a graph: a node a line, names instead of numbers, the layout last.
std::string printGraph(const NodeGraph& graph);

// A graph whose wires fit, in an order in which what is read comes first.
struct CheckedGraph {
    struct Wire {
        uint32_t port = 0, node = 0, output = 0;  // node: place in NodeGraph::nodes
    };
    struct Node {
        const NodeKind* kind = nullptr;  // null: it isn't known
        std::vector<Literal> constants;  // [port]
        std::vector<Wire> wires;         // by port
        std::vector<ValueType> outputs;  // types
        bool muted = false;
        int loop = -1;        // place in `loops` of what it repeats; -1: nothing
        std::string missing;  // of what isn't wired though it has to be: why it can't be made; "": nothing is
        bool unsure = false;  // what it gives can't be known before what it reads is
    };
    // Nodes that are made once for each pass of a node that repeats them: all that lie on a way from the opener to the
    // repeated input.
    struct Loop {
        uint32_t opener = 0;                        // in nodes
        Wire root;                                  // what a pass gives
        std::vector<uint32_t> body;                 // in order, the opener first; empty: passes don't differ
        std::unordered_map<uint32_t, uint32_t> at;  // node -> place in `body`
        uint32_t reads = 0;                         // a bit for each output of the opener that the body reads
    };
    std::vector<Node> nodes;  // as NodeGraph::nodes
    std::vector<uint32_t> order;
    std::vector<Loop> loops;
    std::vector<uint32_t> shown;
    std::vector<Diagnostic> warnings;
};
// Fails with every mistake: a missing node, a type that doesn't fit, a number out of range, wires that go round in a
// circle (it names the way). unfinished: nodes that wait for wires are none; each fails by itself when the graph runs.
Result<CheckedGraph> checkGraph(const NodeGraph& graph, bool unfinished = false);

// Why a port doesn't take this constant, as the rest of a sentence about it; "": it does.
std::string mistakeInConstant(const Literal& constant, const NodePort& port);

// A number as texts have it: the shortest that reads as the same one.
std::string numberText(float number);

}  // namespace espalier
