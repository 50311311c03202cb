#version 460
#extension GL_GOOGLE_include_directive : require
// Terminals of a regrowth's nodes: see keepAgain.
#define ESPALIER_TABLES
#include "shaders/shared/extensions.glsl"
#define LANE_BINDING 1
#define LANE_SLOTS 0u
#include "shaders/shared/lane_slots.glsl"   // before what uses slots
#include "shaders/expand/again_terminals.h"
#include "shaders/expand/node_trips.glsl"

layout(local_size_x = 32) in;
layout(push_constant, scalar) uniform Push { ExpandEnv env; };

void main() {
    openLane(kSlotWords);
    openAgain(env);
    uint count = complete(env) ? AGAIN.counts[kListWork] : 0u;
    uint capacity = AGAIN.resultCapacity;
    if (count > capacity) {
        AGAIN.overrun = 1u;
        return;
    }
    UintBuf results = AGAIN.results;
    UintBuf firstLeaves = env.status.v[0].firstLeaves;
    nextLeavesAtHand = env.status.v[0].nextLeaves;
    uvec2 hash = uvec2(0u);
    for (uint k = 0u; nodeOfTrip(k) < count; ++k) {
        uint i = nodeOfTrip(k);
        keepAgain(env, results, capacity, i, firstLeaves, finishNode(env, workNode(results, i), hash));
    }
    addHash(env, gl_WorkGroupID.x, hash);
}
