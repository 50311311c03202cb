#version 460
#extension GL_GOOGLE_include_directive : require
// A group a chunk, an invocation a node.
#include "shaders/shared/extensions.glsl"
#include "shaders/expand/compact.h"

layout(local_size_x = 32) in;
layout(push_constant, scalar) uniform Push { CompactEnv env; };

void main() {
    for (uint c = gl_WorkGroupID.x; c < env.chunkCount; c += gl_NumWorkGroups.x) moveNode(env, c, gl_LocalInvocationID.x);
}
