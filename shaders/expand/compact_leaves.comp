#version 460
#extension GL_GOOGLE_include_directive : require
// The leaves that there are, in no certain order.
#include "shaders/shared/extensions.glsl"
#include "shaders/expand/compact.h"

layout(local_size_x = 32) in;
layout(push_constant, scalar) uniform Push { CompactEnv env; };

void main() {
    uint lanes = gl_NumWorkGroups.x * kExpandGroup;
    for (uint i = gl_GlobalInvocationID.x; i < env.leafCount; i += lanes) {
        bool stays = env.leaves.v[i].node != kNoIndex;
        if (stays) moveLeaf(env, i, atomicAdd(env.status.v[0].leaves, 1u));
        if (!stays) env.leavesWent.v[i] = kNoIndex;
    }
}
