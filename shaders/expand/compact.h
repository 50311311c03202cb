// Closing the gaps that edits leave among nodes and leaves, in three passes one after another: places, nodes, leaves.
// Chunks and branches keep their places. What the compact_*.comp kernels share.
#ifndef ESPALIER_EXPAND_COMPACT_H
#define ESPALIER_EXPAND_COMPACT_H
#include "shaders/shared/expand_env.h"

ESPALIER_BEGIN

struct CompactEnv {
    NodeBuf nodes, toNodes;
    LeafBuf leaves, toLeaves;
    ChunkBuf chunks, toChunks;        // toChunks: a copy at first
    UintBuf nodesWent, leavesWent;    // GrowthMove::nodes, ::leaves; of nodes kNoIndex at first
    GrowStatusBuf status;             // nodes, leaves: how many there are now
    UintBuf firstLeaves, nextLeaves;  // GrowStatus's, which native code takes along; not given: leaves aren't chained
    uint chunkCount, leafCount;       // before, with gaps
    uint nodeCount;                   // likewise, for native code
    uint spare;
};
STATIC_SIZE(CompactEnv, 104);

// Gives a chunk's nodes their new places.
FN void placeChunk(CompactEnv env, uint chunk) {
    uint count = chunkNodes(env.chunks.v[chunk].marks);
    if (count > 0u) env.toChunks.v[chunk].firstNode = atomicAdd(env.status.v[0].nodes, count);
}

// The new place of a node that there is.
FN uint placeOf(CompactEnv env, uint node) {
    uint owner = env.nodes.v[node].chunk;
    return env.toChunks.v[owner].firstNode + node - env.chunks.v[owner].firstNode;
}

// Moves node `lane` of a chunk, and with the first one the chunk's link to the node that it starts from.
FN void moveNode(CompactEnv env, uint chunk, uint lane) {
    uint marks = env.chunks.v[chunk].marks;
    uint from = env.chunks.v[chunk].firstNode + lane;
    uint to = env.toChunks.v[chunk].firstNode + lane;
    if (lane < chunkNodes(marks)) {
        env.toNodes.v[to] = env.nodes.v[from];
        env.nodesWent.v[from] = to;
    }
    uint foot = marks != 0u && lane == 0u ? env.chunks.v[chunk].previousNode : kNoIndex;
    if (foot != kNoIndex) env.toChunks.v[chunk].previousNode = placeOf(env, foot);
}

FN void moveLeaf(CompactEnv env, uint leaf, uint to) {
    Leaf moved = env.leaves.v[leaf];
    moved.node = placeOf(env, moved.node);
    env.toLeaves.v[to] = moved;
    env.leavesWent.v[leaf] = to;
}

ESPALIER_END
#endif
