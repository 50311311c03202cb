#version 460
#extension GL_GOOGLE_include_directive : require
#define ESPALIER_AGAIN
// Dirty chunks with no dirty chunk before them are the first wave; the others wait for these. And leaves are chained to
// their nodes, where they aren't yet.
#include "shaders/shared/extensions.glsl"
#include "shaders/expand/again.glsl"

layout(local_size_x = 32) in;
layout(push_constant, scalar) uniform Push { ExpandEnv env; };

// Chains leaves that others than the terminal pass have put there.
void chainLeaves() {
    UintBuf firstLeaves = env.status.v[0].firstLeaves;
    UintBuf nextLeaves = env.status.v[0].nextLeaves;
    uint end = AGAIN.leafCount;
    uint lanes = gl_NumWorkGroups.x * kExpandGroup;
    for (uint i = AGAIN.chainedLeaves + gl_GlobalInvocationID.x; i < end; i += lanes) {
        uint node = env.leaves.v[i].node;
        if (node != kNoIndex) nextLeaves.v[i] = atomicExchange(firstLeaves.v[node], i);
    }
}

void main() {
    openAgain(env);
    chainLeaves();
    uint count = listed(env, kListDirty);
    uint lanes = gl_NumWorkGroups.x * kExpandGroup;
    for (uint i = gl_GlobalInvocationID.x; i < count; i += lanes) {
        uint chunk = listEntry(env, kListDirty, i);
        uint below = chunk;
        uint above = env.chunks.v[chunk].parent;
        while (above != kNoIndex && (againMarks.v[above].bits & kMarkDirty) == 0u) {
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
