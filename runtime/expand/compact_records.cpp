// In: records as they lie in the buffers, with the gaps that edits left. Out: the same without gaps, renumbered.
#include "runtime/expand/growth_plan.hpp"

namespace espalier {
namespace {

// Moves what stays to the front and returns the new index of each; kNoIndex: it doesn't.
template <class T, class Stays>
std::vector<uint32_t> closeGaps(std::vector<T>& values, Stays&& stays) {
    std::vector<uint32_t> to(values.size(), kNoIndex);
    uint32_t count = 0;
    for (uint32_t i = 0; i < values.size(); ++i) {
        if (!stays(values[i])) continue;
        values[count] = values[i];
        to[i] = count++;
    }
    values.resize(count);
    return to;
}

// Lists of chunks lead past those that there aren't any more.
void skipGaps(std::vector<Chunk>& chunks) {
    const auto there = [&](uint32_t at) {
        while (at != kNoIndex && chunks[at].marks == 0) at = chunks[at].nextSibling;
        return at;
    };
    for (Chunk& c : chunks) {
        if (c.marks == 0) continue;
        c.firstChild = there(c.firstChild);
        c.nextSibling = there(c.nextSibling);
    }
}

void renumber(uint32_t& index, const std::vector<uint32_t>& to) {
    if (index != kNoIndex) index = to[index];
}

}  // namespace

void compactRecords(GrowthRecords& g) {
    skipGaps(g.chunks);
    const auto nodes = closeGaps(g.nodes, [](const Node& n) { return !isGap(n); });
    const auto chunks = closeGaps(g.chunks, [](const Chunk& c) { return c.marks != 0; });
    const auto branches = closeGaps(g.branches, [](const BranchRecord& b) { return b.firstChunk != kNoIndex; });
    closeGaps(g.leaves, [](const Leaf& l) { return l.node < kLeafPending; });
    for (Node& n : g.nodes) n.chunk = chunks[n.chunk];
    for (Leaf& l : g.leaves) l.node = nodes[l.node];
    for (BranchRecord& b : g.branches) b.firstChunk = chunks[b.firstChunk];
    for (Chunk& c : g.chunks) {
        for (uint32_t* link : {&c.parent, &c.next, &c.firstChild, &c.nextSibling}) renumber(*link, chunks);
        renumber(c.previousNode, nodes);
        if (chunkNodes(c.marks) > 0) c.firstNode = nodes[c.firstNode];
        renumber(c.branch, branches);
    }
}

}  // namespace espalier
