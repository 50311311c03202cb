// Reads of growth's own records: nodes, chunks and branches, after the kernels that wrote them.
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
Node readNode(ExpandEnv env, uint at) { return env.nodes.v[at]; }
vec3 readPosition(ExpandEnv env, uint at) { return env.nodes.v[at].position; }
NodeArc readArc(ExpandEnv env, uint at) {
    return NodeArc(env.nodes.v[at].arc, env.nodes.v[at].chunk, env.nodes.v[at].flags);
}

ChunkBrief readBrief(ExpandEnv env, uint at) {
    ChunkBrief c;
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
    return c;
}
uint64_t readKey(ExpandEnv env, uint chunk) { return env.chunks.v[chunk].key; }
uint readBranchOf(ExpandEnv env, uint chunk) { return env.chunks.v[chunk].branch; }
uint readFirstNode(ExpandEnv env, uint chunk) { return env.chunks.v[chunk].firstNode; }
uint readMarks(ExpandEnv env, uint chunk) { return env.chunks.v[chunk].marks; }
BranchRecord readBranch(ExpandEnv env, uint at) { return env.branches.v[at]; }
void writeLeaf(LeafBuf leaves, uint at, Leaf leaf) {
    PairBuf to = PairBuf(uint64_t(leaves) + uint64_t(at) * 16u);
    to.v[0] = pairOf(leaf.node, leaf.place);
    to.v[1] = pairOf(leaf.pose, leaf.tint);
}
#endif

ESPALIER_END
#endif
