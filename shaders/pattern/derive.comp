#version 460
#extension GL_GOOGLE_include_directive : require
// Symbols of a wave -> shapes, with room for their sets.
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
    uint count = e.status.v[0].wave;
    uint lanes = gl_NumWorkGroups.x * kPatternGroup;
    for (uint i = gl_GlobalInvocationID.x; i < count; i += lanes) deriveItem(e, i);
}
