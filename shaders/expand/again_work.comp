#version 460
#extension GL_GOOGLE_include_directive : require
// A regrowth's pass over branches with grown chunks.
#include "shaders/shared/extensions.glsl"
#include "shaders/expand/again_work.h"

layout(local_size_x = 32) in;
layout(push_constant, scalar) uniform Push { ExpandEnv env; };

void main() {
    openAgain(env);
    if (!complete(env)) return;
    uint count = listed(env, kListBranches);
    uint lanes = gl_NumWorkGroups.x * kExpandGroup;
    for (uint i = gl_GlobalInvocationID.x; i < count; i += lanes) workAgain(env, i);
}
