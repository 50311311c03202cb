// Reads of the records that a regrowth takes out, as record_lookup.h has those that stand.
#ifndef ESPALIER_EXPAND_AGAIN_LOOKUP_H
#define ESPALIER_EXPAND_AGAIN_LOOKUP_H
#include "shaders/shared/record_lookup.h"

ESPALIER_BEGIN

// What is asked of a chunk as it was before.
struct ChunkBefore {
    u64 key;
    uint previousNode, firstNode, step, marks;
};

#ifdef __cplusplus
inline ChunkBefore readBefore(ChunkBuf before, uint at) {
    const Chunk& c = before.v[at];
    return {c.key, c.previousNode, c.firstNode, c.step, c.marks};
}
inline Leaf readLeaf(const ExpandEnv& env, uint at) { return env.leaves.v[at]; }
#else
ChunkBefore readBefore(ChunkBuf before, uint at) {
    return ChunkBefore(before.v[at].key, before.v[at].previousNode, before.v[at].firstNode, before.v[at].step,
                       before.v[at].marks);
}
Leaf readLeaf(ExpandEnv env, uint at) { return env.leaves.v[at]; }
#endif

ESPALIER_END
#endif
