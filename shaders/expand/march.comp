#version 460
#extension GL_GOOGLE_include_directive : require
// One wave of the queue: an invocation takes an item and grows its chunk.
#include "shaders/shared/extensions.glsl"
#include "shaders/shared/expand_grow.h"

layout(local_size_x = 32) in;
layout(push_constant, scalar) uniform Push { ExpandEnv env; };

void main() {
    uint count = min(env.waves.v[env.wave].count, env.itemCapacity);
    uint lanes = gl_NumWorkGroups.x * kExpandGroup;
    for (uint i = gl_GlobalInvocationID.x; i < count; i += lanes) {
        growChunk(env, env.items.v[i]);
    }
}
