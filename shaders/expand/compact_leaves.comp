#version 460
#extension GL_GOOGLE_include_directive : require
// Moves the leaves that there are, in no certain order.
#include "shaders/shared/extensions.glsl"
#include "shaders/expand/compact.h"

layout(local_size_x = 32) in;
layout(push_constant, scalar) uniform Push { CompactEnv env; };

void main() {
    uint lanes = gl_NumWorkGroups.x * kExpandGroup;
    for (uint i = gl_GlobalInvocationID.x; i < env.leafCount; i += lanes) {
        Leaf leaf = env.leaves.v[i];
        if (leaf.node == kNoIndex) continue;
        uint owner = env.nodes.v[leaf.node].chunk;
        leaf.node = env.toChunks.v[owner].firstNode + leaf.node - env.chunks.v[owner].firstNode;
        env.toLeaves.v[atomicAdd(env.status.v[0].leaves, 1u)] = leaf;
    }
}
