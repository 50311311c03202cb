#version 460
#extension GL_GOOGLE_include_directive : require
// Terminals of a regrowth's nodes, a group a chunk: leaves as pending ones, the rest aside, since it may yet prove too
// much.
#define ESPALIER_TABLES
#define ESPALIER_RECORD_FETCH
#include "shaders/shared/extensions.glsl"
#include "shaders/expand/again.glsl"
#include "shaders/shared/expand_terminals.h"

layout(local_size_x = 32) in;
layout(push_constant, scalar) uniform Push { ExpandEnv env; };

void main() {
    openAgain(env);
    uint count = complete(env) ? listed(env, kListWork) : 0u;
    if (count > AGAIN.resultCapacity) {
        AGAIN.overrun = 1u;
        return;
    }
    UintBuf results = AGAIN.results;
    uint lane = gl_LocalInvocationID.x;
    uvec2 hash = uvec2(0u);
    for (uint i = gl_WorkGroupID.x; i < count; i += gl_NumWorkGroups.x) {
        uint chunk = listEntry(env, kListWork, i);
        bool wanted = ((againMarks.v[chunk].nodes >> lane) & 1u) != 0u;
        // A loop, since software devices skip only those.
        for (uint k = 0u; k < (wanted ? 1u : 0u); ++k) {
            NodeFinish finish = finishNode(env, readFirstNode(env, chunk) + lane, hash);
            uint at = (i * kChunkNodes + lane) * 3u;
            results.v[at] = finish.tangent;
            results.v[at + 1u] = finish.flags;
            results.v[at + 2u] = floatBitsToUint(finish.radius);
        }
    }
    uint slot = (gl_WorkGroupID.x & (kHashSlots - 1u)) * 2u;
    atomicAdd(env.status.v[0].hash[slot], hash.x);
    atomicAdd(env.status.v[0].hash[slot + 1u], hash.y);
}
