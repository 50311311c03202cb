// Closing gaps in native code, in place. In: what is drawn, by pointer, with the gaps that regrowths have left. Out:
// the same without gaps, links by the new numbers.
#include "runtime/host/kernels.hpp"
#include "shaders/expand/compact.h"

namespace espalier {
namespace {

constexpr size_t kChunksAtOnce = 1024, kItemsAtOnce = 16384;

// Nodes that there are move up, a chunk's together. Returns how many there are.
uint32_t moveNodes(const CompactEnv& env) {
    uint32_t to = 0;
    for (uint32_t from = 0; from < env.nodeCount;) {
        const uint32_t owner = env.nodes.v[from].chunk;
        Chunk* chunk = owner < env.chunkCount ? &env.chunks.v[owner] : nullptr;
        const uint32_t count = chunk && chunk->firstNode == from ? chunkNodes(chunk->marks) : 0;
        if (count == 0) {
            env.nodesWent.v[from++] = kNoIndex;
            continue;
        }
        chunk->firstNode = to;
        for (uint32_t i = 0; i < count; ++i, ++from, ++to) {
            env.nodes.v[to] = env.nodes.v[from];
            if (IS_GIVEN(env.firstLeaves)) env.firstLeaves.v[to] = env.firstLeaves.v[from];
            env.nodesWent.v[from] = to;
        }
    }
    return to;
}

uint32_t moveLeaves(const CompactEnv& env) {
    Leaf* leaves = env.leaves.v;
    uint32_t end = env.leafCount;
    const auto dropGaps = [&](uint32_t least) {
        while (end > least && leaves[end - 1].node == kNoIndex) env.leavesWent.v[--end] = kNoIndex;
    };
    dropGaps(0);
    for (uint32_t i = 0; i < end; ++i) {
        env.leavesWent.v[i] = i;
        if (leaves[i].node != kNoIndex) continue;
        env.leavesWent.v[i] = kNoIndex;
        leaves[i] = leaves[--end];
        if (IS_GIVEN(env.nextLeaves)) env.nextLeaves.v[i] = env.nextLeaves.v[end];
        env.leavesWent.v[end] = i;
        dropGaps(i + 1);
    }
    return end;
}

// Chunks' links to nodes, links between nodes and leaves, and from leaf to leaf.
void relink(const CompactEnv& env, Crew& crew) {
    const GrowStatus& now = env.status.v[0];
    const auto leafNow = [&](uint32_t leaf) { return leaf < env.leafCount ? env.leavesWent.v[leaf] : kNoIndex; };
    crew.overRange(env.chunkCount, kChunksAtOnce, [&](size_t begin, size_t end) {
        for (size_t c = begin; c < end; ++c) {
            Chunk& chunk = env.chunks.v[c];
            if (chunk.marks != 0 && chunk.previousNode != kNoIndex)
                chunk.previousNode = env.nodesWent.v[chunk.previousNode];
        }
    });
    crew.overRange(now.leaves, kItemsAtOnce, [&](size_t begin, size_t end) {
        for (size_t i = begin; i < end; ++i) env.leaves.v[i].node = env.nodesWent.v[env.leaves.v[i].node];
        for (size_t i = begin; i < end && IS_GIVEN(env.nextLeaves); ++i)
            env.nextLeaves.v[i] = leafNow(env.nextLeaves.v[i]);
    });
    crew.overRange(IS_GIVEN(env.firstLeaves) ? now.nodes : 0, kItemsAtOnce, [&](size_t begin, size_t end) {
        for (size_t i = begin; i < end; ++i) env.firstLeaves.v[i] = leafNow(env.firstLeaves.v[i]);
    });
}

// Closes gaps in place: env.toNodes, toLeaves and toChunks are env.nodes, leaves and chunks. Nodes move up in their
// order, leaves from the end come into the gaps; none goes to a higher number.
void closeGaps(CompactEnv env, const HostRun& run) {
    GrowStatus& now = env.status.v[0];
    run.crew.overRange(2, 1, [&](size_t part, size_t) {
        if (part == 0)
            now.nodes = moveNodes(env);
        else
            now.leaves = moveLeaves(env);
    });
    relink(env, run.crew);
}

constexpr HostRow kRows[] = {{"expand/close_gaps", passOf<CompactEnv, closeGaps>}};

}  // namespace

const std::span<const HostRow> kGapRows = kRows;

}  // namespace espalier
