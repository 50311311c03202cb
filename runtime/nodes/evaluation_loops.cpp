// In: a node that repeats others, and a pass. Out: what those others make in this pass.
#include <algorithm>

#include "runtime/nodes/evaluation.hpp"

namespace espalier {
namespace {

// Of all loops that lie in each other.
constexpr uint64_t kMostPassNodes = 1000000;
constexpr uint32_t kMostDepth = 8;

}  // namespace

// What a node has made as its reader sees it: in the innermost pass that makes it, or once for all.
const NodeEvaluation::Made& NodeEvaluation::madeIn(const Scope* scope, uint32_t n) const {
    for (; scope; scope = scope->outer)
        if (const auto place = scope->loop->at.find(n); place != scope->loop->at.end())
            return (*scope->nodes)[place->second];
    return running_[n];
}

Result<const NodeValue*> NodeEvaluation::makePass(const Scope* outer, uint32_t n, Made& made, const LoopPass& given,
                                                  NodeWorkList& list) {
    const CheckedGraph::Loop& loop = checked_.loops[size_t(checked_.nodes[n].loop)];
    const uint32_t root = loop.root.node;
    if (loop.body.empty()) return &madeIn(outer, root).outputs[loop.root.output];
    Scope scope{outer, &loop, &given, nullptr, given.count, 1};
    if (outer) {
        scope.passes *= outer->passes;
        scope.depth += outer->depth;
    }
    // All is counted before the first pass, so that nothing is made in vain.
    if (scope.depth > kMostDepth)
        return Failure("", "nodes that repeat lie more than " + std::to_string(kMostDepth) + " deep in each other");
    if (scope.passes * loop.body.size() > kMostPassNodes)
        return Failure("", std::to_string(scope.passes) + " passes of " + std::to_string(loop.body.size()) +
                               " nodes are more than 1,000,000 in all");
    made.passes.resize(given.count);
    Pass& pass = made.passes[given.index];
    pass.nodes.resize(loop.body.size());
    const Version version = running_[root].version->version();
    const bool stands =
        !outer && pass.madeFrom == version && pass.given.count == given.count && pass.given.place == given.place;
    if (!stands) {
        pass.madeFrom = 0;
        pass.given = given;
        pass.given.carried = nullptr;
        scope.nodes = &pass.nodes;
        if (Status done = makeBody(scope, list); !done) return done.failure();
        pass.madeFrom = version;
    }
    return &pass.nodes[loop.at.at(root)].outputs[loop.root.output];
}

Status NodeEvaluation::makeBody(const Scope& scope, NodeWorkList& list) {
    for (size_t i = 0; i < scope.loop->body.size(); ++i) {
        const uint32_t n = scope.loop->body[i];
        Made& made = (*scope.nodes)[i];
        if (Status done = makeIn(&scope, n, made, list); !done) return done;
        const std::string where = "in pass " + std::to_string(scope.given->index) + " of " +
                                  std::to_string(scope.given->count) + ", '" + graph_.nodes[n].name + "' ";
        if (!made.failure.empty()) return Failure("", where + made.failure);
        if (made.blocked) return Failure("", where + "waits for a node that has failed");
    }
    return Done{};
}

// Whether passes of a node are of use to the node of its name in another graph.
bool NodeEvaluation::sameLoop(const NodeGraph& graph, const CheckedGraph& checked, uint32_t now,
                              uint32_t before) const {
    const int loop = checked.nodes[now].loop, old = checked_.nodes[before].loop;
    if (loop < 0 || old < 0) return false;
    return std::ranges::equal(
        checked.loops[size_t(loop)].body, checked_.loops[size_t(old)].body, [&](uint32_t a, uint32_t b) {
            return graph.nodes[a].name == graph_.nodes[b].name && checked.nodes[a].kind == checked_.nodes[b].kind;
        });
}

}  // namespace espalier
