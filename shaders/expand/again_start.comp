#version 460
#extension GL_GOOGLE_include_directive : require
#define ESPALIER_AGAIN
// The second pass of a regrowth.
#include "shaders/shared/extensions.glsl"
#include "shaders/expand/again_start.h"

layout(local_size_x = 32) in;
layout(push_constant, scalar) uniform Push { ExpandEnv env; };

void main() {
    openAgain(env);
    UintBuf firstLeaves = env.status.v[0].firstLeaves;
    UintBuf nextLeaves = env.status.v[0].nextLeaves;
    uint lanes = gl_NumWorkGroups.x * kExpandGroup;
    uint end = AGAIN.leafCount;
    for (uint i = AGAIN.chainedLeaves + gl_GlobalInvocationID.x; i < end; i += lanes)
        chainAgain(env, firstLeaves, nextLeaves, i);
    uint count = listed(env, kListDirty);
    for (uint i = gl_GlobalInvocationID.x; i < count; i += lanes) startAgain(env, i);
}
