// Closing the gaps that edits leave among nodes and leaves: what the compact_*.comp kernels are handed, in the order
// places, nodes, leaves. Chunks and branches keep their places.
#ifndef ESPALIER_EXPAND_COMPACT_H
#define ESPALIER_EXPAND_COMPACT_H
#include "shaders/shared/expand_env.h"

ESPALIER_BEGIN

struct CompactEnv {
    NodeBuf nodes, toNodes;
    LeafBuf leaves, toLeaves;
    ChunkBuf chunks, toChunks;   // toChunks: a copy at first
    GrowStatusBuf status;        // nodes, leaves: how many there are now
    uint chunkCount, leafCount;  // before, with gaps
};
STATIC_SIZE(CompactEnv, 64);

ESPALIER_END
#endif
