// A regrowth that holds is published: terminals' results come to the nodes that stay, nodes that are gone are taken out
// with their leaves. What was counted in the structure's hash is taken out of it.
#ifndef ESPALIER_EXPAND_AGAIN_APPLY_H
#define ESPALIER_EXPAND_AGAIN_APPLY_H
#include "shaders/expand/again.h"
#include "shaders/expand/again_lookup.h"
#include "shaders/shared/expand_fit.h"

ESPALIER_BEGIN

// What a regrowth takes out, and what of it the structure's hash has had.
struct GoneTally {
    uvec2 hash;
    uint inserted, feet, deadEnds, stopped, leaves;
};
FN GoneTally nothingGone() {
    GoneTally t = {};
    t.hash = uvec2(0u, 0u);
    t.inserted = 0u;
    t.feet = 0u;
    t.deadEnds = 0u;
    t.stopped = 0u;
    t.leaves = 0u;
    return t;
}
FN void addGone(ExpandEnv env, uint slot, GoneTally t) {
    atomicAdd(AGAIN.goneInserted, t.inserted);
    atomicAdd(AGAIN.goneFeet, t.feet);
    atomicAdd(AGAIN.goneDeadEnds, t.deadEnds);
    atomicAdd(AGAIN.goneStopped, t.stopped);
    atomicAdd(AGAIN.goneLeaves, t.leaves);
    addHash(env, slot, t.hash);
}

struct LeafChains {
    UintBuf first, next;
};

// Takes a node and its leaves out of the hash; its leaves go.
FN void unhash(ExpandEnv env, LeafChains chains, uint index, u64 key, Node node, INOUT(GoneTally) t) {
    t.hash -= hashOfNode(key, node);
    for (uint i = chains.first.v[index]; i != kNoIndex; i = chains.next.v[i]) {
        t.hash -= hashOfLeaf(key, node.flags, readLeaf(env, i));
        env.leaves.v[i].node = kNoIndex;
        t.leaves += 1u;
    }
    chains.first.v[index] = kNoIndex;
}

// Takes out node `lane` of a chunk as it was, and with the first one what the chunk itself counted.
FN void takeOut(ExpandEnv env, LeafChains chains, ChunkBefore was, uint lane, INOUT(GoneTally) t) {
    uint index = was.firstNode + lane;
    if (lane < chunkNodes(was.marks)) {
        Node node = readNode(env, index);
        unhash(env, chains, index, was.key, node, t);
        uint flags = node.flags;
        t.inserted += (flags & kNodeInserted) != 0u ? 1u : 0u;
        t.feet += lane == 0u && was.previousNode == kNoIndex ? 1u : 0u;
        env.nodes.v[index].flags = flags & 0x1F00u;
        env.nodes.v[index].radius = -1.0f;
        AGAIN.touched.v[index] = AGAIN.number;
    }
    if (lane == 0u) {
        t.deadEnds += (was.marks & kChunkDeadEnd) != 0u ? 1u : 0u;
        t.stopped += (was.step >> 24u) + ((was.marks & kChunkStopped) != 0u ? 1u : 0u);
    }
}

// Brings item i of the terminals' results to its node, if that was drawn before; fitAgain notes it as touched.
FN void applyResult(ExpandEnv env, LeafChains chains, UintBuf results, uint capacity, uint i, INOUT(GoneTally) t) {
    if ((results.v[i] & kResultKept) == 0u) return;
    uint index = results.v[i] & ~kResultKept;
    uint at = capacity + kResultWords * i;
    Node node = readNode(env, index);
    unhash(env, chains, index, readKey(env, node.chunk), node, t);
    env.nodes.v[index].tangent = results.v[at];
    env.nodes.v[index].flags = results.v[at + 1u];
    env.nodes.v[index].radius = uintBitsToFloat(results.v[at + 2u]);
    chains.first.v[index] = results.v[at + 3u];
}

ESPALIER_END
#endif
