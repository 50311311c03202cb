#version 460
#extension GL_GOOGLE_include_directive : require
// Tangent, bark and leaves of every node; see expand_terminals.h.
#define ESPALIER_TABLES
#define ESPALIER_RECORD_FETCH
#include "shaders/shared/extensions.glsl"
#include "shaders/shared/expand_terminals.h"

layout(local_size_x = 32) in;
layout(push_constant, scalar) uniform Push { ExpandEnv env; };

uint nodeOfTrip(uint k) {
    const uint each = kNodesPerGroup / kExpandGroup;
    uint block = (k / each) * gl_NumWorkGroups.x + gl_WorkGroupID.x;
    return block * kNodesPerGroup + (k % each) * kExpandGroup + gl_LocalInvocationID.x;
}

void main() {
    uint count = env.status.v[0].nodes;
    bool ready = complete(env);
    uint first = env.status.v[0].frozenNodes;
    uvec2 hash = uvec2(0u);
    // A group's nodes follow each other, so that leaves near each other lie on nodes near each other: see AgainState.
    for (uint k = 0u; ready; ++k) {
        uint i = first + nodeOfTrip(k);
        if (i >= count) break;
        NodeFinish finish = finishNode(env, i, hash);
        if (env.phase == kTerminalsWrite) keepFinish(env.nodes, i, finish);
    }
    uint slot = (gl_WorkGroupID.x & (kHashSlots - 1u)) * 2u;
    atomicAdd(env.status.v[0].hash[slot], hash.x);
    atomicAdd(env.status.v[0].hash[slot + 1u], hash.y);
}
