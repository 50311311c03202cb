// Closing gaps in native code, in place. In: what is drawn, by pointer, with the gaps that regrowths have left. Out:
// the same without gaps, links by the new numbers.
#include "runtime/core/jobs.hpp"
#include "runtime/host/growth.hpp"

namespace espalier {
namespace {

constexpr size_t kChunksAtOnce = 1024, kItemsAtOnce = 16384;

// Nodes that there are move up, a chunk's together.
void moveNodes(GapClosing& closing) {
    uint32_t to = 0;
    for (uint32_t from = 0; from < closing.nodeCount;) {
        const uint32_t owner = closing.nodes[from].chunk;
        Chunk* chunk = owner < closing.chunkCount ? &closing.chunks[owner] : nullptr;
        const uint32_t count = chunk && chunk->firstNode == from ? chunkNodes(chunk->marks) : 0;
        if (count == 0) {
            closing.nodesWent[from++] = kNoIndex;
            continue;
        }
        chunk->firstNode = to;
        for (uint32_t i = 0; i < count; ++i, ++from, ++to) {
            closing.nodes[to] = closing.nodes[from];
            if (closing.firstLeaves) closing.firstLeaves[to] = closing.firstLeaves[from];
            closing.nodesWent[from] = to;
        }
    }
    closing.nodeCount = to;
}

void moveLeaves(GapClosing& closing) {
    Leaf* leaves = closing.leaves;
    uint32_t end = closing.leafCount;
    const auto dropGaps = [&](uint32_t least) {
        while (end > least && leaves[end - 1].node == kNoIndex) closing.leavesWent[--end] = kNoIndex;
    };
    dropGaps(0);
    for (uint32_t i = 0; i < end; ++i) {
        closing.leavesWent[i] = i;
        if (leaves[i].node != kNoIndex) continue;
        closing.leavesWent[i] = kNoIndex;
        leaves[i] = leaves[--end];
        if (closing.nextLeaves) closing.nextLeaves[i] = closing.nextLeaves[end];
        closing.leavesWent[end] = i;
        dropGaps(i + 1);
    }
    closing.leafCount = end;
}

// Chunks' links to nodes, links between nodes and leaves, and from leaf to leaf.
void relink(const GapClosing& closing, uint32_t leavesBefore, Crew& crew) {
    const auto leafNow = [&](uint32_t leaf) { return leaf < leavesBefore ? closing.leavesWent[leaf] : kNoIndex; };
    crew.overRange(closing.chunkCount, kChunksAtOnce, [&](size_t begin, size_t end) {
        for (size_t c = begin; c < end; ++c) {
            Chunk& chunk = closing.chunks[c];
            if (chunk.marks != 0 && chunk.previousNode != kNoIndex)
                chunk.previousNode = closing.nodesWent[chunk.previousNode];
        }
    });
    crew.overRange(closing.leafCount, kItemsAtOnce, [&](size_t begin, size_t end) {
        for (size_t i = begin; i < end; ++i) closing.leaves[i].node = closing.nodesWent[closing.leaves[i].node];
        for (size_t i = begin; i < end && closing.nextLeaves; ++i)
            closing.nextLeaves[i] = leafNow(closing.nextLeaves[i]);
    });
    crew.overRange(closing.firstLeaves ? closing.nodeCount : 0, kItemsAtOnce, [&](size_t begin, size_t end) {
        for (size_t i = begin; i < end; ++i) closing.firstLeaves[i] = leafNow(closing.firstLeaves[i]);
    });
}

}  // namespace

void closeGapsNative(GapClosing& closing, Crew& crew) {
    const uint32_t leavesBefore = closing.leafCount;
    crew.overRange(2, 1, [&](size_t part, size_t) { part == 0 ? moveNodes(closing) : moveLeaves(closing); });
    relink(closing, leavesBefore, crew);
}

}  // namespace espalier
