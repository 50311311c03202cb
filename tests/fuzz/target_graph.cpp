// In: bytes. Out: nothing, if all goes well; a graph that reads is written in one way, which reads as the same graph,
// and small graphs run.
#include <algorithm>

#include "runtime/nodes/evaluation.hpp"
#include "tests/fuzz/promise.hpp"

namespace espalier::fuzz {
namespace {

// Few enough elements that a run takes no time.
bool isSmall(const CheckedGraph& graph) {
    constexpr float kMost = 100;
    if (graph.nodes.size() > 16) return false;
    for (const CheckedGraph::Node& node : graph.nodes) {
        // A fluid's steps are many, so it stays at its first.
        const int time = node.kind && node.kind->name == "Fluid" ? node.kind->port("time") : -1;
        const auto readsTime = [&](const CheckedGraph::Wire& wire) { return int(wire.port) == time; };
        if (time >= 0 && (std::ranges::any_of(node.wires, readsTime) || node.constants[size_t(time)].numbers.x >= 1))
            return false;
        // A limit of instances may be high: there are few without it.
        const int limit = node.kind ? node.kind->port("most") : -1;
        for (size_t p = 0; p < node.constants.size(); ++p)
            for (int i = 0; i < 3; ++i)
                if (int(p) != limit && node.constants[p].kind != Literal::Kind::text &&
                    node.constants[p].numbers[i] > kMost)
                    return false;
    }
    return graph.loops.size() < 2;  // passes of loops in each other are many
}

}  // namespace

void graph(Bytes bytes) {
    Result<NodeGraph> read = parseGraph({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, "fuzzed.graph");
    if (!read) return checkMessage(read.failure());
    const std::string text = printGraph(*read);
    Result<NodeGraph> again = parseGraph(text, "fuzzed.graph");
    require(bool(again), "what is written can be read");
    require(*again == *read, "it is the same graph");
    require(printGraph(*again) == text, "there is one way to write it");
    Result<CheckedGraph> checked = checkGraph(*read);
    if (!checked) return checkMessage(checked.failure());
    require(checked->order.size() == read->nodes.size(), "each node has its place in the order");
    if (!isSmall(*checked)) return;
    NodeEvaluation evaluation(hostMachine(1));
    require(bool(evaluation.load(std::move(*read))), "what has been checked can be loaded");
    require(bool(evaluation.evaluate()), "it runs");
    require(!evaluation.due(), "it has run");
    Result<std::vector<NodeBox>> boxes = evaluation.measure(evaluation.shown());
    require(bool(boxes) && boxes->size() == evaluation.shown().size(), "each part has a box");
}

}  // namespace espalier::fuzz
