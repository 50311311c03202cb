#version 460
#extension GL_GOOGLE_include_directive : require
#define ESPALIER_AGAIN
#define ESPALIER_RECORD_FETCH
// A regrowth that holds is published: terminals' results come to their nodes, nodes that are gone are taken out.
// A group a chunk; what was counted in the structure's hash is taken out of it.
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

// Takes a node out of the hash and lets its leaves go.
void unhash(uint index, u64 key, Node node, UintBuf touched) {
    hash -= hashOfNode(key, node);
    atomicOr(touched.v[index >> 5u], 1u << (index & 31u));
}

void takeOut(ChunkBuf before, UintBuf touched, uint chunk, uint lane) {
    ChunkBefore was = readBefore(before, chunk);
    uint index = was.firstNode + lane;
    for (uint k = 0u; k < (lane < chunkNodes(was.marks) ? 1u : 0u); ++k) {
        Node node = readNode(env, index);
        unhash(index, was.key, node, touched);
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
    UintBuf touched = AGAIN.touched;
    UintBuf results = AGAIN.results;
    uint count = listed(env, kListWork);
    for (uint i = gl_WorkGroupID.x; i < count; i += gl_NumWorkGroups.x) {
        uint chunk = listEntry(env, kListWork, i);
        bool wanted = ((againMarks.v[chunk].nodes >> lane) & 1u) != 0u;
        bool grown = (againMarks.v[chunk].bits & kMarkGrown) != 0u;
        for (uint k = 0u; k < (wanted ? 1u : 0u); ++k) {
            uint index = readFirstNode(env, chunk) + lane;
            for (uint once = 0u; once < (grown ? 0u : 1u); ++once)
                unhash(index, readKey(env, chunk), readNode(env, index), touched);
            uint at = (i * kChunkNodes + lane) * 3u;
            env.nodes.v[index].tangent = results.v[at];
            env.nodes.v[index].flags = results.v[at + 1u];
            env.nodes.v[index].radius = uintBitsToFloat(results.v[at + 2u]);
        }
    }
    count = listed(env, kListGrown);
    for (uint i = gl_WorkGroupID.x; i < count; i += gl_NumWorkGroups.x) {
        uint chunk = listEntry(env, kListGrown, i);
        if ((againMarks.v[chunk].bits & kMarkAgain) != 0u) takeOut(before, touched, chunk, lane);
    }
    count = listed(env, kListGone);
    for (uint i = gl_WorkGroupID.x; i < count; i += gl_NumWorkGroups.x) {
        uint chunk = listEntry(env, kListGone, i);
        takeOut(before, touched, chunk, lane);
        if (lane == 0u) env.chunks.v[chunk].marks = 0u;
    }
    atomicAdd(AGAIN.goneInserted, inserted);
    atomicAdd(AGAIN.goneFeet, feet);
    atomicAdd(AGAIN.goneDeadEnds, deadEnds);
    atomicAdd(AGAIN.goneStopped, stopped);
    uint slot = (gl_WorkGroupID.x & (kHashSlots - 1u)) * 2u;
    atomicAdd(env.status.v[0].hash[slot], hash.x);
    atomicAdd(env.status.v[0].hash[slot + 1u], hash.y);
}
