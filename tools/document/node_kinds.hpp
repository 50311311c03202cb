#pragma once

#include <array>
#include <span>
#include <string>
#include <vector>

#include "plugin_api/espalier.h"

namespace espalier::document {

// The plugin's table of node kinds, read once.
struct NodePort {
    std::string name, unit, help;
    EspNodeType type = ESP_NODE_NUMBER;
    bool wired = false, many = false;  // see EspNodePort
    bool asFirst = false;
    float low = 0, high = 0;
    std::array<float, 3> standard{};
    std::string text;
    std::string opener = {};  // "": it takes wires to nodes of any kind
    std::vector<std::string> words = {};
};
struct NodeKind {
    std::string name, help, group;
    std::vector<NodePort> inputs, outputs;

    int input(const std::string& wanted) const;   // -1: none
    int output(const std::string& wanted) const;  // likewise; "": the first
};

std::span<const NodeKind> nodeKinds();                  // by name
const NodeKind* findNodeKind(const std::string& name);  // null: the plugin doesn't know it

// How many numbers a value of the type has: 1, 3, or 0 of what isn't made of numbers.
int numbersOf(EspNodeType type);
bool isText(EspNodeType type);      // a text in quotes: also a file or a choice
bool isGeometry(EspNodeType type);  // points, curves, a mesh or several of these
bool canBeShown(EspNodeType type);  // these, and what stands elsewhere in the scene: plants, a town

}  // namespace espalier::document
