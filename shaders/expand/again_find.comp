#version 460
#extension GL_GOOGLE_include_directive : require
// The first pass of a regrowth, over all chunks.
#include "shaders/shared/extensions.glsl"
#include "shaders/expand/again_find.h"

layout(local_size_x = 32) in;
layout(push_constant, scalar) uniform Push { ExpandEnv env; };

void main() {
    openAgain(env);
    EditHead head = editHead(env);
    uint count = AGAIN.chunkCount;
    uint lanes = gl_NumWorkGroups.x * kExpandGroup;
    for (uint c = gl_GlobalInvocationID.x; c < count; c += lanes) findChunk(env, head, c);
}
