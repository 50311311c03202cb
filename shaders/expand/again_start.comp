#version 460
#extension GL_GOOGLE_include_directive : require
#define ESPALIER_AGAIN
// Dirty chunks with no dirty chunk before them are the first wave; the others wait for these.
#include "shaders/shared/extensions.glsl"
#include "shaders/expand/again.glsl"

layout(local_size_x = 32) in;
layout(push_constant, scalar) uniform Push { ExpandEnv env; };

void main() {
    AgainMarkBuf marks = AGAIN.marks;
    uint count = listed(env, kListDirty);
    uint lanes = gl_NumWorkGroups.x * kExpandGroup;
    for (uint i = gl_GlobalInvocationID.x; i < count; i += lanes) {
        uint chunk = listEntry(env, kListDirty, i);
        uint below = chunk;
        uint above = env.chunks.v[chunk].parent;
        while (above != kNoIndex && (marks.v[above].bits & kMarkDirty) == 0u) {
            below = above;
            above = env.chunks.v[above].parent;
        }
        if (above == kNoIndex) {
            queueAgain(env, env.items, 0u, chunk, kItemsPerGroupAgain);
        } else {
            waitFor(env, chunk, below);
        }
    }
}
