#version 460
#extension GL_GOOGLE_include_directive : require
// A regrowth's pass over grown chunks.
#include "shaders/shared/extensions.glsl"
#include "shaders/expand/again_settle.h"

layout(local_size_x = 32) in;
layout(push_constant, scalar) uniform Push { ExpandEnv env; };

void main() {
    openAgain(env);
    if (!complete(env)) return;
    ChunkBuf before = AGAIN.chunksBefore;
    uint count = listed(env, kListGrown);
    uint lanes = gl_NumWorkGroups.x * kExpandGroup;
    for (uint i = gl_GlobalInvocationID.x; i < count; i += lanes) settleAgain(env, before, i);
}
