#version 460
#extension GL_GOOGLE_include_directive : require
#define ESPALIER_AGAIN
// The end of a regrowth: radii, the structure's hash, and leaves: pending ones are shown, those of touched nodes go.
#include "shaders/shared/extensions.glsl"
#include "shaders/expand/again.glsl"
#include "shaders/shared/expand_fit.h"

layout(local_size_x = 32) in;
layout(push_constant, scalar) uniform Push { ExpandEnv env; };

uvec2 hash = uvec2(0u);

void fitChunks(uint lane) {
    AgainMarkBuf marks = AGAIN.marks;
    uint count = listed(env, kListFit);
    for (uint i = gl_WorkGroupID.x; i < count; i += gl_NumWorkGroups.x) {
        uint chunk = listEntry(env, kListFit, i);
        bool there = lane < chunkNodes(env.chunks.v[chunk].marks);
        bool counted = ((marks.v[chunk].nodes >> lane) & 1u) == 0u;   // others were taken out of the hash before
        for (uint k = 0u; k < (there ? 1u : 0u); ++k) {
            uint index = env.chunks.v[chunk].firstNode + lane;
            if (counted) hash -= hashOfNode(env.chunks.v[chunk].key, env.nodes.v[index]);
            hash += fitNode(env, index);
        }
    }
}

uint sweepLeaves() {
    UintBuf touched = AGAIN.touched;
    uint gone = 0u;
    uint count = env.status.v[0].leaves;
    uint lanes = gl_NumWorkGroups.x * kExpandGroup;
    for (uint i = gl_GlobalInvocationID.x; i < count; i += lanes) {
        uint node = env.leaves.v[i].node;
        bool pending = node != kNoIndex && (node & kLeafPending) != 0u;
        bool goes = node < kLeafPending && ((touched.v[node >> 5u] >> (node & 31u)) & 1u) != 0u;
        if (pending) env.leaves.v[i].node = node & ~kLeafPending;
        for (uint k = 0u; k < (goes ? 1u : 0u); ++k) {
            u64 key = AGAIN.chunksBefore.v[env.nodes.v[node].chunk].key;
            hash -= hashOfLeaf(key, env.nodes.v[node].flags, env.leaves.v[i]);
            env.leaves.v[i].node = kNoIndex;
            gone += 1u;
        }
    }
    return gone;
}

void main() {
    if (!holds(env)) return;
    fitChunks(gl_LocalInvocationID.x);
    uint gone = sweepLeaves();
    if (gone > 0u) atomicAdd(AGAIN.goneLeaves, gone);
    uint slot = (gl_WorkGroupID.x & (kHashSlots - 1u)) * 2u;
    atomicAdd(env.status.v[0].hash[slot], hash.x);
    atomicAdd(env.status.v[0].hash[slot + 1u], hash.y);
}
