// Hash-consed expressions: folding, a few identities that hold to the bit, classification.
#include "runtime/grammar/graph.hpp"

#include <algorithm>

namespace espalier::grammar {

Graph::Graph() {
    constant(0.0f);
    constant(1.0f);
}

Node Graph::intern(const GraphNode& node) {
    uint64_t hash = combineKeys((uint64_t(node.leaf) << 32) | node.op, floatBitsToUint(node.value));
    for (uint32_t i = 0; i < node.kidCount; ++i) hash = combineKeys(hash, node.kids[i]);
    std::vector<Node>& bucket = byHash_[hash];
    for (Node n : bucket) {
        const GraphNode& other = nodes_[n];
        bool same = other.leaf == node.leaf && other.op == node.op && other.kidCount == node.kidCount &&
                    floatBitsToUint(other.value) == floatBitsToUint(node.value) &&
                    std::equal(node.kids, node.kids + node.kidCount, other.kids);
        if (same) return n;
    }
    nodes_.push_back(node);
    bucket.push_back(static_cast<Node>(nodes_.size() - 1));
    return bucket.back();
}

Node Graph::constant(float value) {
    GraphNode node;
    node.leaf = Leaf::constant;
    node.value = tamed(value);
    node.boolean = node.value == 0.0f || node.value == 1.0f;
    return intern(node);
}

Node Graph::leaf(Leaf kind, uint32_t number) {
    GraphNode node;
    node.leaf = kind;
    node.op = number;
    node.mistaken = kind == Leaf::mistake;
    node.uniform = kind == Leaf::param || node.mistaken;
    node.params = kind == Leaf::param ? 1u << number : 0u;
    return intern(node);
}

// An equal but simpler node, or kNone. Only identities that hold for every number the machine can hold.
Node Graph::simplified(uint32_t op, Node x, Node y, Node z) {
    switch (op) {
        case kOpMove:
            return x;
        case kOpAdd:
            if (isConstant(y, 0.0f)) return x;
            if (isConstant(x, 0.0f)) return y;
            break;
        case kOpSub:
            if (isConstant(y, 0.0f)) return x;
            // Subtracting what is fixed is adding its opposite, for which the rules above and below are made.
            if (isFixed(y) && !isFixed(x)) return make(kOpAdd, x, make(kOpSub, zero(), y));
            break;
        case kOpMul:
            if (isConstant(x, 0.0f) || isConstant(y, 1.0f)) return x;
            if (isConstant(y, 0.0f) || isConstant(x, 1.0f)) return y;
            break;
        case kOpMin:
        case kOpMax:
            if (x == y) return x;
            if (nodes_[x].boolean && nodes_[y].boolean) {
                float strong = op == kOpMin ? 0.0f : 1.0f;
                if (isConstant(x)) return isConstant(x, strong) ? x : y;
                if (isConstant(y)) return isConstant(y, strong) ? y : x;
            }
            break;
        case kOpSelect:
            // The choice asks by itself whether a number holds.
            if (nodes_[x].leaf == Leaf::operation && nodes_[x].op == kOpLessEq && isConstant(nodes_[x].kids[0], 0.5f))
                return make(kOpSelect, nodes_[x].kids[1], y, z);
            if (isConstant(x)) return holds(nodes_[x].value) ? y : z;
            if (y == z) return y;
            if (nodes_[x].boolean && isConstant(y, 1.0f) && isConstant(z, 0.0f)) return x;
            break;
        case kOpEqual: {
            // A choice between rules, asked for one of them, is a condition.
            if (x == y) return one();
            const GraphNode choice = nodes_[x];
            bool pushes =
                isConstant(y) && choice.leaf == Leaf::operation && choice.op == kOpSelect && isConstant(choice.kids[1]);
            if (!pushes) break;
            Node rest = make(kOpEqual, choice.kids[2], y);
            if (isConstant(choice.kids[1], nodes_[y].value)) return either(choice.kids[0], rest);
            return both(negation(choice.kids[0]), rest);
        }
        default:
            break;
    }
    return kNone;
}

// (x + a) + b = x + (a + b), (x a) b = x (a b), (x a + b) c = x (a c) + b c for fixed a, b, c: the host does more of
// the work. The rounding differs from the text's order, but this is what the text means, on every device.
Node Graph::withFixedTogether(uint32_t op, Node x, Node y) {
    const GraphNode left = nodes_[x];
    if (isFixed(x) || !isFixed(y) || left.leaf != Leaf::operation || left.kidCount != 2 || !isFixed(left.kids[1]))
        return kNone;
    if ((op == kOpAdd || op == kOpMul) && left.op == op) return make(op, left.kids[0], make(op, left.kids[1], y));
    if (op != kOpMul || left.op != kOpAdd) return kNone;
    const GraphNode product = nodes_[left.kids[0]];
    if (product.leaf != Leaf::operation || product.op != kOpMul || !isFixed(product.kids[1])) return kNone;
    return add(mul(product.kids[0], mul(product.kids[1], y)), mul(left.kids[1], y));
}

Node Graph::make(uint32_t op, Node x, Node y, Node z) {
    Node simple = simplified(op, x, y, z);
    if (simple != kNone) return simple;
    // What is fixed stands on the right, so that equal expressions meet.
    bool commutes = op == kOpAdd || op == kOpMul || op == kOpMin || op == kOpMax;
    if (commutes && isFixed(x) && (!isFixed(y) || isConstant(x))) std::swap(x, y);
    Node regrouped = commutes ? withFixedTogether(op, x, y) : kNone;
    if (regrouped != kNone) return regrouped;

    GraphNode node;
    node.op = op;
    Node kids[3] = {x, y, z};
    bool constant = true, fixed = true, booleans = true;
    float v[3] = {};
    for (; node.kidCount < 3 && kids[node.kidCount] != kNone; ++node.kidCount) {
        uint32_t i = node.kidCount;
        const GraphNode& kid = nodes_[kids[i]];
        node.kids[i] = kids[i];
        node.params |= kid.params;
        node.mistaken = node.mistaken || kid.mistaken;
        node.depth = std::max(node.depth, kid.depth + 1);
        bool kidConstant = kid.leaf == Leaf::constant;
        constant = constant && kidConstant;
        fixed = fixed && (kidConstant || kid.uniform);
        booleans = booleans && (kid.boolean || (op == kOpSelect && i == 0));
        v[i] = kid.value;
    }
    if (constant) return this->constant(applyOperation(op, v[0], v[1], v[2]));
    node.uniform = fixed;
    node.boolean = op == kOpLess || op == kOpLessEq || op == kOpEqual ||
                   (booleans && (op == kOpMul || op == kOpMin || op == kOpMax || op == kOpSelect)) ||
                   (op == kOpSub && isConstant(x, 1.0f) && nodes_[y].boolean);
    return intern(node);
}

bool Graph::isPowerOfTwo(Node n) const {
    const float value = nodes_[n].value;
    return isConstant(n) && absolute(value) > 1e-9f && (floatBitsToUint(value) & 0x7FFFFFu) == 0;
}

Node Graph::quotient(Node x, Node y) {
    if (isPowerOfTwo(y)) return mul(x, constant(1.0f / nodes_[y].value));
    return make(kOpDiv, x, y);
}

Node Graph::remainder(Node x, Node y) {
    const Node rest = sub(x, mul(y, make(kOpFloor, quotient(x, y))));
    if (isPowerOfTwo(y)) return rest;
    // Quotient and product are rounded, the one maybe up to a whole number: then the rest is one y off.
    const Node raised = select(make(kOpLess, mul(rest, y), zero()), add(rest, y), rest);
    return select(make(kOpLessEq, make(kOpAbs, y), make(kOpAbs, raised)), sub(raised, y), raised);
}

}  // namespace espalier::grammar
