#pragma once

#include <cstdint>
#include <unordered_map>
#include <vector>

#include "shaders/shared/interpreter.h"

// Expressions as a graph in which equal ones are one node. What is constant is folded by the interpreter's own
// operations, so that folding changes no bit; what depends on parameters alone is marked, to be worked out by the
// host when a parameter changes.
namespace espalier::grammar {

using Node = uint32_t;

enum class Leaf : uint32_t { operation, constant, param, slot, draw, mistake };

struct GraphNode {
    Leaf leaf = Leaf::operation;
    uint32_t op = 0;  // operation: kOp...; param: its slot; slot: the machine's; draw: its site
    Node kids[3] = {};
    uint32_t kidCount = 0;
    float value = 0;        // constant
    uint32_t params = 0;    // parameter slots below
    uint32_t depth = 0;     // operations from here to the farthest leaf
    bool uniform = false;   // parameters and constants only, at least one parameter
    bool boolean = false;   // 0 or 1
    bool mistaken = false;  // a mistake is below
};

class Graph {
  public:
    Graph();
    Node constant(float value);
    Node leaf(Leaf kind, uint32_t number);
    // Of a leaf: parameters that what fills it is worked out from.
    void dependsOn(Node leaf, uint32_t params) { nodes_[leaf].params |= params; }
    Node make(uint32_t op, Node x, Node y, Node z);
    Node make(uint32_t op, Node x, Node y) { return make(op, x, y, kNone); }
    Node make(uint32_t op, Node x) { return make(op, x, kNone, kNone); }

    Node zero() const { return 0; }
    Node one() const { return 1; }
    // What stands for an expression that was reported. No number is known of it, and it may stand wherever what is
    // fixed may, so that it isn't reported again for what it is used for.
    Node mistake() { return leaf(Leaf::mistake, 0); }
    Node add(Node x, Node y) { return make(kOpAdd, x, y); }
    Node sub(Node x, Node y) { return make(kOpSub, x, y); }
    Node mul(Node x, Node y) { return make(kOpMul, x, y); }
    Node select(Node test, Node yes, Node no) { return make(kOpSelect, test, yes, no); }
    Node truth(Node x) { return (*this)[x].boolean ? x : make(kOpLessEq, constant(0.5f), x); }
    Node both(Node x, Node y) { return make(kOpMin, truth(x), truth(y)); }
    Node either(Node x, Node y) { return make(kOpMax, truth(x), truth(y)); }
    Node negation(Node x) { return sub(one(), truth(x)); }
    // x / y, rounded once.
    Node quotient(Node x, Node y);
    // What x is above the next lower multiple of y: in [0, y), for y < 0 in (y, 0].
    Node remainder(Node x, Node y);
    // a + t (b - a)
    Node mix(Node a, Node b, Node t) { return add(mul(t, sub(b, a)), a); }

    const GraphNode& operator[](Node n) const { return nodes_[n]; }
    bool isConstant(Node n) const { return nodes_[n].leaf == Leaf::constant; }
    bool isConstant(Node n, float value) const { return isConstant(n) && nodes_[n].value == value; }
    bool isFixed(Node n) const { return isConstant(n) || nodes_[n].uniform; }
    bool isMistaken(Node n) const { return nodes_[n].mistaken; }
    size_t size() const { return nodes_.size(); }

    static constexpr Node kNone = 0xFFFFFFFFu;

  private:
    // A constant whose inverse is one, too: multiplying by that rounds nothing and costs less than dividing.
    bool isPowerOfTwo(Node n) const;
    Node intern(const GraphNode& node);
    Node withFixedTogether(uint32_t op, Node x, Node y);
    Node simplified(uint32_t op, Node x, Node y, Node z);
    std::vector<GraphNode> nodes_;
    std::unordered_map<uint64_t, std::vector<Node>> byHash_;
};

}  // namespace espalier::grammar
