#version 460
#extension GL_GOOGLE_include_directive : require
#define ESPALIER_AGAIN
#define ESPALIER_RECORD_FETCH
// A regrowth that holds is published: terminals' results come to their nodes, nodes that are gone are taken out
// with their leaves. What was counted in the structure's hash is taken out of it.
#include "shaders/shared/extensions.glsl"
#include "shaders/expand/again.glsl"
#include "shaders/expand/again_lookup.glsl"
#include "shaders/shared/expand_fit.h"

layout(local_size_x = 32) in;
layout(push_constant, scalar) uniform Push { ExpandEnv env; };

uvec2 hash = uvec2(0u);
uint inserted = 0u;
uint feet = 0u;
uint deadEnds = 0u;
uint stopped = 0u;
uint leaves = 0u;

// Takes a node and its leaves out of the hash; its leaves go.
void unhash(uint index, u64 key, Node node, UintBuf firstLeaves, UintBuf nextLeaves) {
    hash -= hashOfNode(key, node);
    for (uint i = firstLeaves.v[index]; i != kNoIndex; i = nextLeaves.v[i]) {
        hash -= hashOfLeaf(key, node.flags, readLeaf(env, i));
        env.leaves.v[i].node = kNoIndex;
        leaves += 1u;
    }
    firstLeaves.v[index] = kNoIndex;
}

void takeOut(ChunkBuf before, UintBuf firstLeaves, UintBuf nextLeaves, uint chunk, uint lane) {
    ChunkBefore was = readBefore(before, chunk);
    uint index = was.firstNode + lane;
    for (uint k = 0u; k < (lane < chunkNodes(was.marks) ? 1u : 0u); ++k) {
        Node node = readNode(env, index);
        unhash(index, was.key, node, firstLeaves, nextLeaves);
        uint flags = node.flags;
        inserted += (flags & kNodeInserted) != 0u ? 1u : 0u;
        feet += lane == 0u && was.previousNode == kNoIndex ? 1u : 0u;
        env.nodes.v[index].flags = flags & 0x1F00u;
        env.nodes.v[index].radius = -1.0;
    }
    if (lane == 0u) {
        deadEnds += (was.marks & kChunkDeadEnd) != 0u ? 1u : 0u;
        stopped += (was.step >> 24u) + ((was.marks & kChunkStopped) != 0u ? 1u : 0u);
    }
}

void main() {
    openAgain(env);
    if (!holds(env)) return;
    uint lane = gl_LocalInvocationID.x;
    ChunkBuf before = AGAIN.chunksBefore;
    UintBuf firstLeaves = env.status.v[0].firstLeaves;
    UintBuf nextLeaves = env.status.v[0].nextLeaves;
    UintBuf results = AGAIN.results;
    uint lanes = gl_NumWorkGroups.x * kExpandGroup;
    uint count = AGAIN.counts[kListWork];
    for (uint i = gl_GlobalInvocationID.x; i < count; i += lanes) {
        uint at = kResultWords * i;
        uint index = results.v[at];
        Node node = readNode(env, index);
        for (bool old = (againMarks.v[node.chunk].bits & kMarkGrown) == 0u; old; old = false)
            unhash(index, readKey(env, node.chunk), node, firstLeaves, nextLeaves);
        env.nodes.v[index].tangent = results.v[at + 1u];
        env.nodes.v[index].flags = results.v[at + 2u];
        env.nodes.v[index].radius = uintBitsToFloat(results.v[at + 3u]);
        firstLeaves.v[index] = results.v[at + 4u];
    }
    count = listed(env, kListGrown);
    for (uint i = gl_WorkGroupID.x; i < count; i += gl_NumWorkGroups.x) {
        uint chunk = listEntry(env, kListGrown, i);
        if ((againMarks.v[chunk].bits & kMarkAgain) != 0u) takeOut(before, firstLeaves, nextLeaves, chunk, lane);
    }
    count = listed(env, kListGone);
    for (uint i = gl_WorkGroupID.x; i < count; i += gl_NumWorkGroups.x) {
        uint chunk = listEntry(env, kListGone, i);
        takeOut(before, firstLeaves, nextLeaves, chunk, lane);
        if (lane == 0u) env.chunks.v[chunk].marks = 0u;
    }
    atomicAdd(AGAIN.goneInserted, inserted);
    atomicAdd(AGAIN.goneFeet, feet);
    atomicAdd(AGAIN.goneDeadEnds, deadEnds);
    atomicAdd(AGAIN.goneStopped, stopped);
    atomicAdd(AGAIN.goneLeaves, leaves);
    uint slot = (gl_WorkGroupID.x & (kHashSlots - 1u)) * 2u;
    atomicAdd(env.status.v[0].hash[slot], hash.x);
    atomicAdd(env.status.v[0].hash[slot + 1u], hash.y);
}
