#pragma once

// Actions that change procedural graphs; a part of action.hpp. Nodes are named as in the graph's text.

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace espalier::document {

// A procedural graph that comes to the scene, as its last. The file need not be there yet.
struct AddGraph {
    static constexpr const char* kName = "graph";
    std::string file, text;
    template <class V>
    void fields(V&& v) {
        v("file", file), v("text", text);
    }
};
struct SetGraphText {
    static constexpr const char* kName = "graph_text";
    uint32_t graph = 0;
    std::string text;
    std::string runs = {};  // what ran while the text had mistakes; kept for undo, no part of a run
    template <class V>
    void fields(V&& v) {
        v("graph", graph), v("text", text);
    }
};
// Nodes of a text of their own, with their places on the canvas. Their names are new to the graph.
struct AddNodes {
    static constexpr const char* kName = "add_nodes";
    uint32_t graph = 0;
    std::string text;
    template <class V>
    void fields(V&& v) {
        v("graph", graph), v("text", text);
    }
};
// With their wires. bridge: who has read one of them reads what was wired to its first input, where that fits.
struct RemoveNodes {
    static constexpr const char* kName = "remove_nodes";
    uint32_t graph = 0;
    std::vector<std::string> nodes;
    bool bridge = false;
    template <class V>
    void fields(V&& v) {
        v("graph", graph), v("nodes", nodes), v("bridge", bridge);
    }
};
struct SetNodeInput {
    static constexpr const char* kName = "node_input";
    uint32_t graph = 0;
    std::string node, input;
    std::string value;  // as the text has it: 0.5, (1, 2, 3), "normal"; empty: the kind's standard
    template <class V>
    void fields(V&& v) {
        v("graph", graph), v("node", node), v("input", input), v("value", value);
    }
};
struct ConnectNodes {
    static constexpr const char* kName = "connect";
    static constexpr uint32_t kLast = 1000000;
    uint32_t graph = 0;
    std::string node, input;
    std::string wire;        // a node or its output, as the text has it; empty: the wire goes
    uint32_t place = kLast;  // among the wires of an input that takes many; beyond them: one more, or all that go
    template <class V>
    void fields(V&& v) {
        v("graph", graph), v("node", node), v("input", input), v("wire", wire), v("place", place);
    }
};
struct MoveNodes {
    static constexpr const char* kName = "move_nodes";
    uint32_t graph = 0;
    std::vector<std::string> nodes;
    std::vector<std::array<float, 2>> places;  // of each on the canvas
    template <class V>
    void fields(V&& v) {
        v("graph", graph), v("nodes", nodes), v("places", places);
    }
};
struct RenameNode {
    static constexpr const char* kName = "rename_node";
    uint32_t graph = 0;
    std::string node, name;
    template <class V>
    void fields(V&& v) {
        v("graph", graph), v("node", node), v("name", name);
    }
};
// Those that are shown, and no others.
struct ShowNodes {
    static constexpr const char* kName = "show_nodes";
    uint32_t graph = 0;
    std::vector<std::string> nodes;
    template <class V>
    void fields(V&& v) {
        v("graph", graph), v("nodes", nodes);
    }
};
struct MuteNodes {
    static constexpr const char* kName = "mute_nodes";
    uint32_t graph = 0;
    std::vector<std::string> nodes;
    bool muted = true;
    template <class V>
    void fields(V&& v) {
        v("graph", graph), v("nodes", nodes), v("muted", muted);
    }
};

}  // namespace espalier::document
