#version 460
#extension GL_GOOGLE_include_directive : require
// Gives each chunk's nodes their new places.
#include "shaders/shared/extensions.glsl"
#include "shaders/expand/compact.h"

layout(local_size_x = 32) in;
layout(push_constant, scalar) uniform Push { CompactEnv env; };

void main() {
    uint lanes = gl_NumWorkGroups.x * kExpandGroup;
    for (uint c = gl_GlobalInvocationID.x; c < env.chunkCount; c += lanes) {
        uint count = chunkNodes(env.chunks.v[c].marks);
        if (count > 0u) env.toChunks.v[c].firstNode = atomicAdd(env.status.v[0].nodes, count);
    }
}
