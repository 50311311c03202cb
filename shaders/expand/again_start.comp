#version 460
#extension GL_GOOGLE_include_directive : require
#define ESPALIER_AGAIN
// Dirty chunks with no dirty chunk before them are the first wave; the others wait for these. And the ranges of nodes
// that new blocks of leaves lie on.
#include "shaders/shared/extensions.glsl"
#include "shaders/expand/again.glsl"

layout(local_size_x = 32) in;
layout(push_constant, scalar) uniform Push { ExpandEnv env; };

void findRanges() {
    uint blocks = (AGAIN.leafCount + kLeafBlock - 1u) / kLeafBlock;
    uint lanes = gl_NumWorkGroups.x * kExpandGroup;
    UintBuf ranges = AGAIN.leafRanges;
    for (uint b = AGAIN.rangedLeaves / kLeafBlock + gl_GlobalInvocationID.x; b < blocks; b += lanes) {
        uint low = kNoIndex;
        uint high = 0u;
        uint end = min((b + 1u) * kLeafBlock, AGAIN.leafCount);
        for (uint i = b * kLeafBlock; i < end; ++i) {
            uint node = env.leaves.v[i].node;
            low = min(low, node);
            high = max(high, node == kNoIndex ? 0u : node);
        }
        ranges.v[2u * b] = low;
        ranges.v[2u * b + 1u] = high;
    }
}

void main() {
    openAgain(env);
    findRanges();
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
