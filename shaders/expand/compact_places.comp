#version 460
#extension GL_GOOGLE_include_directive : require
// A chunk each.
#include "shaders/shared/extensions.glsl"
#include "shaders/expand/compact.h"

layout(local_size_x = 32) in;
layout(push_constant, scalar) uniform Push { CompactEnv env; };

void main() {
    uint lanes = gl_NumWorkGroups.x * kExpandGroup;
    for (uint c = gl_GlobalInvocationID.x; c < env.chunkCount; c += lanes) placeChunk(env, c);
}
