#version 460
#extension GL_GOOGLE_include_directive : require
// Tangent, bark and leaves of every node; see expand_terminals.h.
#define ESPALIER_TABLES
#include "shaders/shared/extensions.glsl"
#define LANE_BINDING 1
#define LANE_SLOTS 0u
#include "shaders/shared/lane_slots.glsl"   // before what uses slots
#include "shaders/shared/expand_terminals.h"
#include "shaders/expand/node_trips.glsl"

layout(local_size_x = 32) in;
layout(push_constant, scalar) uniform Push { ExpandEnv env; };

void main() {
    openLane(kSlotWords);
    uint count = env.status.v[0].nodes;
    bool ready = complete(env);
    uint first = env.status.v[0].frozenNodes;
    uvec2 hash = uvec2(0u);
    nextLeavesAtHand = env.status.v[0].nextLeaves;
    UintBuf firstLeaves = env.status.v[0].firstLeaves;
    bool writes = env.phase == kTerminalsWrite;
    for (uint k = 0u; ready; ++k) {
        uint i = first + nodeOfTrip(k);
        if (i >= count) break;
        if ((kFeatures & kFeatureAvoid) != 0u && env.nodes.v[i].radius < 0.0f) {
            firstLeaves.v[i] = kNoIndex;
            continue;
        }
        NodeFinish finish = finishNode(env, i, hash);
        if (!writes) continue;
        keepFinish(env.nodes, i, finish);
        firstLeaves.v[i] = finish.firstLeaf;
    }
    addHash(env, gl_WorkGroupID.x, hash);
}
