#version 460
#extension GL_GOOGLE_include_directive : require
// Moves nodes to their places, a group a chunk, and follows with the links to them.
#include "shaders/shared/extensions.glsl"
#include "shaders/expand/compact.h"

layout(local_size_x = 32) in;
layout(push_constant, scalar) uniform Push { CompactEnv env; };

void main() {
    uint lane = gl_LocalInvocationID.x;
    for (uint c = gl_WorkGroupID.x; c < env.chunkCount; c += gl_NumWorkGroups.x) {
        uint marks = env.chunks.v[c].marks;
        uint from = env.chunks.v[c].firstNode + lane;
        uint to = env.toChunks.v[c].firstNode + lane;
        // Loops, since software devices skip only those.
        for (uint k = 0u; k < (lane < chunkNodes(marks) ? 1u : 0u); ++k) env.toNodes.v[to] = env.nodes.v[from];
        uint foot = marks != 0u && lane == 0u ? env.chunks.v[c].previousNode : kNoIndex;
        for (uint k = 0u; k < (foot != kNoIndex ? 1u : 0u); ++k) {
            uint owner = env.nodes.v[foot].chunk;
            env.toChunks.v[c].previousNode = env.toChunks.v[owner].firstNode + foot - env.chunks.v[owner].firstNode;
        }
    }
}
