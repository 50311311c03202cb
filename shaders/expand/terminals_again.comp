#version 460
#extension GL_GOOGLE_include_directive : require
// Terminals of a regrowth's nodes: leaves as pending ones, the rest aside, since it may yet prove too much.
#define ESPALIER_TABLES
#define ESPALIER_RECORD_FETCH
#include "shaders/shared/extensions.glsl"
#include "shaders/expand/again.glsl"
#include "shaders/shared/expand_terminals.h"
#include "shaders/expand/node_trips.glsl"

layout(local_size_x = 32) in;
layout(push_constant, scalar) uniform Push { ExpandEnv env; };

void main() {
    openAgain(env);
    uint count = complete(env) ? AGAIN.counts[kListWork] : 0u;
    if (count > AGAIN.resultCapacity) {
        AGAIN.overrun = 1u;
        return;
    }
    UintBuf results = AGAIN.results;
    nextLeavesAtHand = env.status.v[0].nextLeaves;
    uvec2 hash = uvec2(0u);
    for (uint k = 0u; nodeOfTrip(k) < count; ++k) {
        uint at = kResultWords * nodeOfTrip(k);
        NodeFinish finish = finishNode(env, results.v[at], hash);
        results.v[at + 1u] = finish.tangent;
        results.v[at + 2u] = finish.flags;
        results.v[at + 3u] = floatBitsToUint(finish.radius);
        results.v[at + 4u] = finish.firstLeaf;
    }
    uint slot = (gl_WorkGroupID.x & (kHashSlots - 1u)) * 2u;
    atomicAdd(env.status.v[0].hash[slot], hash.x);
    atomicAdd(env.status.v[0].hash[slot + 1u], hash.y);
}
