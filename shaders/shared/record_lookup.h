// Reads of growth's own records: nodes, chunks and branches, after the kernels that wrote them.
//
// Kernels that define ESPALIER_RECORD_FETCH read them as texels of 16 bytes: on software devices a read by address is a
// loop over lanes for each word, a texel comes in one piece. Specialised to kRecordsByAddress they read as others do.
#ifndef ESPALIER_SHARED_RECORD_LOOKUP_H
#define ESPALIER_SHARED_RECORD_LOOKUP_H
#include "shaders/shared/expand_env.h"

ESPALIER_BEGIN

// What the pass over nodes needs of a chunk.
struct ChunkBrief {
    u64 key;
    float entryArc;
    uint symbol;
    vec4 args;
    uint previousNode, next, branch, firstNode, depth, step, marks;
};

// Where a node lies in its branch.
struct NodeArc {
    float arc;
    uint chunk, flags;
};

#ifdef __cplusplus
inline const Node& readNode(ExpandEnv env, uint at) { return env.nodes.v[at]; }
inline vec3 readPosition(ExpandEnv env, uint at) { return env.nodes.v[at].position; }
inline NodeArc readArc(ExpandEnv env, uint at) {
    const Node& node = env.nodes.v[at];
    return {node.arc, node.chunk, loadShared(node.flags)};
}
inline ChunkBrief readBrief(ExpandEnv env, uint at) {
    const Chunk& c = env.chunks.v[at];
    return {c.key, c.entry.arc, c.symbol, vec4(c.args[0], c.args[1], c.args[2], c.args[3]),
            c.previousNode, c.next, c.branch, c.firstNode, c.depth, c.step, c.marks};
}
inline u64 readKey(ExpandEnv env, uint chunk) { return env.chunks.v[chunk].key; }
inline uint readBranchOf(ExpandEnv env, uint chunk) { return env.chunks.v[chunk].branch; }
inline uint readFirstNode(ExpandEnv env, uint chunk) { return env.chunks.v[chunk].firstNode; }
inline uint readMarks(ExpandEnv env, uint chunk) { return env.chunks.v[chunk].marks; }
inline BranchRecord readBranch(ExpandEnv env, uint at) { return env.branches.v[at]; }
inline void writeLeaf(LeafBuf leaves, uint at, const Leaf& leaf) { leaves.v[at] = leaf; }
#else
#ifdef ESPALIER_RECORD_FETCH
layout(constant_id = 3) const uint kRecordsByAddress = 1u;
layout(binding = 2) uniform usamplerBuffer nodeTexels;
layout(binding = 3) uniform usamplerBuffer chunkTexels;
layout(binding = 4) uniform usamplerBuffer branchTexels;
#define NODE_TEXEL(i) texelFetch(nodeTexels, int(i))
#define CHUNK_TEXEL(i) texelFetch(chunkTexels, int(i))
#define BRANCH_TEXEL(i) texelFetch(branchTexels, int(i))
#else
const uint kRecordsByAddress = 1u;
#define NODE_TEXEL(i) uvec4(0u)
#define CHUNK_TEXEL(i) uvec4(0u)
#define BRANCH_TEXEL(i) uvec4(0u)
#endif

// A node is eleven words, so it begins with any word of a texel: `skip` is how many of the first are another's.
Node readNode(ExpandEnv env, uint at) {
    if (kRecordsByAddress != 0u) return env.nodes.v[at];
    uint first = (11u * at) >> 2u;
    uint skip = (0u - at) & 3u;
    uvec4 a = NODE_TEXEL(first);
    uvec4 b = NODE_TEXEL(first + 1u);
    uvec4 c = NODE_TEXEL(first + 2u);
    uvec4 d = NODE_TEXEL(first + 3u);
    bool two = (skip & 2u) != 0u;
    bool one = (skip & 1u) != 0u;
    a = two ? uvec4(a.zw, b.xy) : a;
    b = two ? uvec4(b.zw, c.xy) : b;
    c = two ? uvec4(c.zw, d.xy) : c;
    d.x = two ? d.z : d.x;
    a = one ? uvec4(a.yzw, b.x) : a;
    b = one ? uvec4(b.yzw, c.x) : b;
    c = one ? uvec4(c.yzw, d.x) : c;
    return Node(uintBitsToFloat(a.xyz), a.w, b.x, b.y, b.z, uintBitsToFloat(b.w), uintBitsToFloat(c.x), c.y, c.z);
}
// Words 4 * texel to 4 * texel + 2 of a node.
uvec3 nodeWords(uint at, uint texel) {
    uint first = ((11u * at) >> 2u) + texel;
    uint skip = (0u - at) & 3u;
    uvec4 a = NODE_TEXEL(first);
    uvec4 b = NODE_TEXEL(first + 1u);
    bool one = (skip & 1u) != 0u;
    uvec3 low = one ? a.yzw : a.xyz;
    uvec3 high = one ? uvec3(a.w, b.xy) : uvec3(a.zw, b.x);
    return (skip & 2u) != 0u ? high : low;
}
vec3 readPosition(ExpandEnv env, uint at) {
    if (kRecordsByAddress != 0u) return env.nodes.v[at].position;
    return uintBitsToFloat(nodeWords(at, 0u));
}
NodeArc readArc(ExpandEnv env, uint at) {
    if (kRecordsByAddress != 0u) return NodeArc(env.nodes.v[at].arc, env.nodes.v[at].chunk, env.nodes.v[at].flags);
    uvec3 words = nodeWords(at, 2u);
    return NodeArc(uintBitsToFloat(words.x), words.y, words.z);
}

ChunkBrief readBrief(ExpandEnv env, uint at) {
    ChunkBrief c;
    if (kRecordsByAddress != 0u) {
        PairBuf from = PairBuf(uint64_t(env.chunks) + uint64_t(at) * 112u);
        c.key = from.v[0];
        uvec2 p = unpackUint2x32(from.v[4]);
        c.entryArc = uintBitsToFloat(p.x);
        c.symbol = p.y;
        c.args = vec4(uintBitsToFloat(unpackUint2x32(from.v[5])), uintBitsToFloat(unpackUint2x32(from.v[6])));
        c.previousNode = unpackUint2x32(from.v[7]).y;
        p = unpackUint2x32(from.v[8]);
        c.next = p.x;
        c.branch = p.y;
        p = unpackUint2x32(from.v[9]);
        c.firstNode = p.x;
        c.depth = p.y;
        p = unpackUint2x32(from.v[10]);
        c.step = p.x;
        c.marks = p.y;
    } else {
        uint first = 7u * at;
        c.key = packUint2x32(CHUNK_TEXEL(first).xy);
        uvec4 a = CHUNK_TEXEL(first + 2u);
        uvec4 b = CHUNK_TEXEL(first + 3u);
        uvec4 d = CHUNK_TEXEL(first + 4u);
        uvec4 e = CHUNK_TEXEL(first + 5u);
        c.entryArc = uintBitsToFloat(a.x);
        c.symbol = a.y;
        c.args = uintBitsToFloat(uvec4(a.zw, b.xy));
        c.previousNode = b.w;
        c.next = d.x;
        c.branch = d.y;
        c.firstNode = d.z;
        c.depth = d.w;
        c.step = e.x;
        c.marks = e.y;
    }
    return c;
}
uint64_t readKey(ExpandEnv env, uint chunk) {
    if (kRecordsByAddress != 0u) return env.chunks.v[chunk].key;
    return packUint2x32(CHUNK_TEXEL(7u * chunk).xy);
}
uint readBranchOf(ExpandEnv env, uint chunk) {
    if (kRecordsByAddress != 0u) return env.chunks.v[chunk].branch;
    return CHUNK_TEXEL(7u * chunk + 4u).y;
}
uint readFirstNode(ExpandEnv env, uint chunk) {
    if (kRecordsByAddress != 0u) return env.chunks.v[chunk].firstNode;
    return CHUNK_TEXEL(7u * chunk + 4u).z;
}
uint readMarks(ExpandEnv env, uint chunk) {
    if (kRecordsByAddress != 0u) return env.chunks.v[chunk].marks;
    return CHUNK_TEXEL(7u * chunk + 5u).y;
}
BranchRecord readBranch(ExpandEnv env, uint at) {
    if (kRecordsByAddress != 0u) return env.branches.v[at];
    uvec4 t = BRANCH_TEXEL(at);
    return BranchRecord(uintBitsToFloat(t.x), uintBitsToFloat(t.y), t.z, t.w);
}
void writeLeaf(LeafBuf leaves, uint at, Leaf leaf) {
    PairBuf to = PairBuf(uint64_t(leaves) + uint64_t(at) * 16u);
    to.v[0] = pairOf(leaf.node, leaf.place);
    to.v[1] = pairOf(leaf.pose, leaf.tint);
}
#endif

ESPALIER_END
#endif
