#pragma once

#include <array>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "tools/document/node_kinds.hpp"

namespace espalier::document {

// What a node is given at an input: a constant, or a wire.
struct GraphGiven {
    std::string input;  // "" of a kind that isn't known
    EspGraphValueKind kind = ESP_GRAPH_NUMBER;
    std::array<float, 3> numbers{};
    std::string text;
    std::string from, output;  // of a wire: the node, and its output, or "" for the first
    bool wire() const { return kind == ESP_GRAPH_WIRE; }
};

struct GraphNode {
    std::string name, kind;
    std::vector<GraphGiven> inputs;
    std::optional<std::string> comments;  // lines before it
    uint32_t line = 0;

    const GraphGiven* given(const std::string& input) const;  // the first at that input; null: nothing is said
};

// A graph's text as nodes, for who edits it. The plugin reads texts; what this writes it reads as the same graph.
class GraphModel {
  public:
    using Place = std::array<float, 2>;
    std::vector<GraphNode> nodes;
    std::vector<std::string> shown, muted;
    std::vector<std::pair<std::string, Place>> layout;
    std::optional<std::string> remarks;  // comments behind all nodes

    // False: `error` tells each mistake of the writing. file: for messages.
    bool read(EspContext* context, const std::string& text, const std::string& file, std::string& error);
    std::string write() const;

    int find(const std::string& name) const;  // -1: there is none
    std::optional<Place> placeOf(const std::string& name) const;
    void place(const std::string& name, Place at);
    bool isShown(const std::string& name) const;
    bool isMuted(const std::string& name) const;
    // What an output gives, through nodes that give what they are given; nothing: that isn't known.
    std::optional<EspNodeType> typeOf(const std::string& node, const std::string& output) const;
    // The way of wires from a node to another, both with it; empty: there is none.
    std::vector<std::string> way(const std::string& from, const std::string& to) const;
    // A name that no node has: that of the kind in small letters, or such a name with a number.
    std::string freshName(const std::string& wanted) const;
    // After nodes have come, gone or got other names.
    void index();

  private:
    std::unordered_map<std::string, size_t> places_, named_;  // in layout, in nodes
};

// A value as texts have it.
std::string valueText(const GraphGiven& given);
std::string shortText(float number);  // the shortest that reads as the same number
// Names of nodes: a letter or _, then letters, digits and _.
bool isNodeName(const std::string& name);

}  // namespace espalier::document
