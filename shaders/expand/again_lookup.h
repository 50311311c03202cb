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
layout(binding = 5) uniform usamplerBuffer leafTexels;
layout(binding = 6) uniform usamplerBuffer chunkTexelsBefore;

ChunkBefore readBefore(ChunkBuf before, uint at) {
    ChunkBefore c;
    if (kRecordsByAddress != 0u) {
        c.key = before.v[at].key;
        c.previousNode = before.v[at].previousNode;
        c.firstNode = before.v[at].firstNode;
        c.step = before.v[at].step;
        c.marks = before.v[at].marks;
    } else {
        int first = int(7u * at);
        uvec4 last = texelFetch(chunkTexelsBefore, first + 5);
        c.key = packUint2x32(texelFetch(chunkTexelsBefore, first).xy);
        c.previousNode = texelFetch(chunkTexelsBefore, first + 3).w;
        c.firstNode = texelFetch(chunkTexelsBefore, first + 4).z;
        c.step = last.x;
        c.marks = last.y;
    }
    return c;
}
Leaf readLeaf(ExpandEnv env, uint at) {
    if (kRecordsByAddress != 0u) return env.leaves.v[at];
    uvec4 t = texelFetch(leafTexels, int(at));
    return Leaf(t.x, t.y, t.z, t.w);
}
#endif

ESPALIER_END
#endif
