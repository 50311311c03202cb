#pragma once

// The one table of node kinds. The reader of texts, the checker, the evaluation, the list in docs/graph.md and the
// fuzzer take what they know of kinds from here. A new kind is a row in a file kinds_*.cpp; if it has a kernel, also a
// shader in shaders/nodes, its text in shaders/shared and its native loop in runtime/host/nodes.cpp.

#include <span>

#include "runtime/core/result.hpp"
#include "runtime/nodes/values.hpp"

namespace espalier {

class NodeWork;

struct NodePort {
    std::string name;
    ValueType type = ValueType::number;
    Literal standard = {};    // what it has where a text says nothing; none: it has to be wired
    float low = 0, high = 0;  // of numbers, wholes and each number of a vector; both ends are allowed
    const char* unit = "";
    const char* help = "";
    std::vector<std::string> words = {};  // of a choice
    bool many = false;                    // takes any number of wires; the last port only
    bool optional = false;                // a wire that may be missing
    const char* opener = "";              // the kind that it has to be wired to: where what is repeated begins
};

struct NodeOutput {
    std::string name;
    ValueType type = ValueType::number;
    bool asInput = false;  // it has the type of the first input's wire
};

struct NodeKind {
    std::string name;
    const char* help = "";
    std::vector<NodePort> inputs;
    std::vector<NodeOutput> outputs;  // a wire that names none means the first
    Status (*make)(NodeWork& work) = nullptr;
    std::vector<const char*> kernels = {};  // below shaders/; native loops go by the same names
    bool readsTime = false;
    const char* group = "";  // in lists of kinds
    // The input whose nodes are made once a pass, from the opener on (NodePort::opener). "": nothing is repeated.
    const char* repeats = "";

    int port(std::string_view wanted) const;    // -1: none
    int output(std::string_view wanted) const;  // likewise; "": the first
};

// By name.
std::span<const NodeKind> nodeKinds();
const NodeKind* findNodeKind(std::string_view name);

// Rows of the files kinds_*.cpp.
std::vector<NodeKind> pointKinds();
std::vector<NodeKind> fluidKinds();
std::vector<NodeKind> curveKinds();
std::vector<NodeKind> meshKinds();
std::vector<NodeKind> scatterKinds();
std::vector<NodeKind> loopKinds();
std::vector<NodeKind> modifierKinds();
std::vector<NodeKind> valueKinds();
std::vector<NodeKind> stageKinds();

// Ports that many kinds have.
NodePort numberPort(const char* name, float standard, float low, float high, const char* unit, const char* help);
NodePort wholePort(const char* name, float standard, float low, float high, const char* help);
NodePort vectorPort(const char* name, glm::vec3 standard, float low, float high, const char* unit, const char* help);
NodePort wirePort(const char* name, ValueType type, const char* help);
NodePort seedPort();

}  // namespace espalier
