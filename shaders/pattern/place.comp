#version 460
#extension GL_GOOGLE_include_directive : require
// Pieces of a wave -> their places, and the grid in which others find them.
#include "shaders/shared/extensions.glsl"
#define LANE_BINDING 1
#define LANE_SLOTS 0u
#include "shaders/shared/lane_slots.glsl"   // before what uses slots
#include "shaders/shared/pattern_derive.h"

layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { PatternEnvBuf env; };

void main() {
    openLane(kSlotWords);
    PatternEnv e = env.v[0];
    uint count = foundSetRoom(e) ? e.status.v[0].pieces - e.status.v[0].firstPiece : 0u;
    uint lanes = gl_NumWorkGroups.x * kPatternGroup;
    for (uint i = gl_GlobalInvocationID.x; i < count; i += lanes) placePiece(e, i);
}
