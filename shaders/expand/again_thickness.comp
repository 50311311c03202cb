#version 460
#extension GL_GOOGLE_include_directive : require
#define ESPALIER_AGAIN
// Thickness of the branches that a regrowth may have changed, and the chunks whose radii follow.
#include "shaders/shared/extensions.glsl"
#include "shaders/expand/again.glsl"
#include "shaders/shared/expand_fit.h"

layout(local_size_x = 32) in;
layout(push_constant, scalar) uniform Push { ExpandEnv env; };

void main() {
    openAgain(env);
    if (!holds(env)) return;
    uint count = listed(env, kListKin);
    uint lanes = gl_NumWorkGroups.x * kExpandGroup;
    for (uint i = gl_GlobalInvocationID.x; i < count; i += lanes) {
        uint branch = listEntry(env, kListKin, i);
        float thickness = thicknessOf(env, branch);
        float before = branch < AGAIN.branchCount ? AGAIN.branchesBefore.v[branch].thickness : -1.0;
        bool other = floatBitsToUint(thickness) != floatBitsToUint(before);
        bool work = (againMarks.v[branch].branchBits & kBranchListed) != 0u;
        env.branches.v[branch].thickness = thickness;
        uint chunk = other || work ? env.branches.v[branch].firstChunk : kNoIndex;
        while (chunk != kNoIndex) {
            if (other || againMarks.v[chunk].nodes != 0u) appendTo(env, kListFit, chunk);
            chunk = env.chunks.v[chunk].next;
        }
    }
}
