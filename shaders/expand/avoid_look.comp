#version 460
#extension GL_GOOGLE_include_directive : require
// The chunks of the latest wave begin undecided, and their spans enter the grid: a group a chunk, a lane a node.
#include "shaders/shared/extensions.glsl"
#include "shaders/shared/expand_avoid.h"

layout(local_size_x = 32) in;
layout(push_constant, scalar) uniform Push { ExpandEnv env; };

void main() {
    if (!roomForNodes(env)) return;
    uint end = env.status.v[0].chunks;
    uint lane = gl_LocalInvocationID.x;
    for (uint chunk = env.status.v[0].waveFirst + gl_WorkGroupID.x; chunk < end; chunk += gl_NumWorkGroups.x) {
        if (lane == 0u) beginBounds(env, chunk);
        bool enters = entersGrid(env, chunk) && lane < chunkNodes(env.chunks.v[chunk].marks);
        if (enters) enterSpan(env, readFirstNode(env, chunk) + lane);
    }
}
