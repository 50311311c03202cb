#version 460
#extension GL_GOOGLE_include_directive : require
#define ESPALIER_AGAIN
// A regrowth's pass over branches whose thickness may change.
#include "shaders/shared/extensions.glsl"
#include "shaders/expand/again_fit.h"

layout(local_size_x = 32) in;
layout(push_constant, scalar) uniform Push { ExpandEnv env; };

void main() {
    openAgain(env);
    if (!holds(env)) return;
    uint count = listed(env, kListKin);
    uint lanes = gl_NumWorkGroups.x * kExpandGroup;
    for (uint i = gl_GlobalInvocationID.x; i < count; i += lanes) thickenAgain(env, i);
}
