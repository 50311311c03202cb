#version 460
#extension GL_GOOGLE_include_directive : require
#define ESPALIER_AGAIN
#define ESPALIER_RECORD_FETCH
// The end of a regrowth: radii, the structure's hash, and pending leaves are shown.
#include "shaders/shared/extensions.glsl"
#include "shaders/expand/again.glsl"
#include "shaders/shared/expand_fit.h"

layout(local_size_x = 32) in;
layout(push_constant, scalar) uniform Push { ExpandEnv env; };

uvec2 hash = uvec2(0u);

// As fitNode, with what the chunk's nodes share at hand.
void fitChunks(uint lane) {
    BranchBuf branchesBefore = AGAIN.branchesBefore;
    uint count = listed(env, kListFit);
    for (uint i = gl_WorkGroupID.x; i < count; i += gl_NumWorkGroups.x) {
        uint chunk = listEntry(env, kListFit, i);
        ChunkBrief brief = readBrief(env, chunk);
        bool there = lane < chunkNodes(brief.marks);
        for (uint k = 0u; k < (there ? 1u : 0u); ++k) {
            u64 key = brief.key;
            uint branch = brief.branch;
            uint index = brief.firstNode + lane;
            Node node = readNode(env, index);
            // Others were taken out of the hash before, and have their radius from their terminals.
            bool fresh = ((againMarks.v[chunk].nodes >> lane) & 1u) != 0u;
            for (uint old = 0u; old < (fresh ? 0u : 1u); ++old) {
                hash -= hashOfNode(key, node);
                node.radius = roundRadius(divExact(node.radius, branchesBefore.v[branch].thickness));
            }
            node.radius = node.radius * readBranch(env, branch).thickness;
            env.nodes.v[index].radius = node.radius;
            hash += hashOfNode(key, node);
        }
    }
}

// Pending leaves are drawn from now on.
void showLeaves() {
    uint end = env.status.v[0].leaves;
    uint lanes = gl_NumWorkGroups.x * kExpandGroup;
    for (uint i = AGAIN.leafCount + gl_GlobalInvocationID.x; i < end; i += lanes)
        env.leaves.v[i].node = env.leaves.v[i].node & ~kLeafPending;
}

void main() {
    openAgain(env);
    if (!holds(env)) return;
    fitChunks(gl_LocalInvocationID.x);
    showLeaves();
    uint slot = (gl_WorkGroupID.x & (kHashSlots - 1u)) * 2u;
    atomicAdd(env.status.v[0].hash[slot], hash.x);
    atomicAdd(env.status.v[0].hash[slot + 1u], hash.y);
}
