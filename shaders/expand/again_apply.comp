#version 460
#extension GL_GOOGLE_include_directive : require
#define ESPALIER_AGAIN
// A regrowth's pass that publishes: a group takes a chunk at a time.
#include "shaders/shared/extensions.glsl"
#include "shaders/expand/again_apply.h"

layout(local_size_x = 32) in;
layout(push_constant, scalar) uniform Push { ExpandEnv env; };

void main() {
    openAgain(env);
    if (!holds(env)) return;
    uint lane = gl_LocalInvocationID.x;
    ChunkBuf before = AGAIN.chunksBefore;
    LeafChains chains = LeafChains(env.status.v[0].firstLeaves, env.status.v[0].nextLeaves);
    UintBuf results = AGAIN.results;
    GoneTally tally = nothingGone();
    uint lanes = gl_NumWorkGroups.x * kExpandGroup;
    uint count = AGAIN.counts[kListWork];
    uint capacity = AGAIN.resultCapacity;
    for (uint i = gl_GlobalInvocationID.x; i < count; i += lanes) applyResult(env, chains, results, capacity, i, tally);
    count = listed(env, kListGrown);
    for (uint i = gl_WorkGroupID.x; i < count; i += gl_NumWorkGroups.x) {
        uint chunk = listEntry(env, kListGrown, i);
        if ((AGAIN_MARKS.v[chunk].bits & kMarkAgain) != 0u) takeOut(env, chains, readBefore(before, chunk), lane, tally);
    }
    count = listed(env, kListGone);
    for (uint i = gl_WorkGroupID.x; i < count; i += gl_NumWorkGroups.x) {
        uint chunk = listEntry(env, kListGone, i);
        takeOut(env, chains, readBefore(before, chunk), lane, tally);
        if (lane == 0u) env.chunks.v[chunk].marks = 0u;
    }
    addGone(env, gl_WorkGroupID.x, tally);
}
