#version 460
#extension GL_GOOGLE_include_directive : require
#define ESPALIER_AGAIN
// The last pass of a regrowth: a group takes a chunk at a time.
#include "shaders/shared/extensions.glsl"
#include "shaders/expand/again_fit.h"

layout(local_size_x = 32) in;
layout(push_constant, scalar) uniform Push { ExpandEnv env; };

void main() {
    openAgain(env);
    if (!holds(env)) return;
    uint lane = gl_LocalInvocationID.x;
    BranchBuf branchesBefore = AGAIN.branchesBefore;
    uvec2 hash = uvec2(0u);
    uint count = listed(env, kListFit);
    for (uint i = gl_WorkGroupID.x; i < count; i += gl_NumWorkGroups.x) {
        uint chunk = listEntry(env, kListFit, i);
        ChunkBrief brief = readChunkBrief(env.chunks, chunk);
        bool there = lane < chunkNodes(brief.marks);
        if (there) fitAgain(env, branchesBefore, chunk, brief, lane, hash);
    }
    uint end = env.status.v[0].leaves;
    uint lanes = gl_NumWorkGroups.x * kExpandGroup;
    for (uint i = AGAIN.leafCount + gl_GlobalInvocationID.x; i < end; i += lanes) showLeaf(env, i);
    addHash(env, gl_WorkGroupID.x, hash);
}
