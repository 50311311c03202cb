#version 460
#extension GL_GOOGLE_include_directive : require
// Shapes of one wave -> shapes of the next, grids of terminals; see roof_expand.h.
#include "shaders/shared/extensions.glsl"
#define LANE_BINDING 3
#define LANE_SLOTS 0u
#include "shaders/shared/lane_slots.glsl"   // before what uses slots
#include "shaders/shared/roof_expand.h"

layout(local_size_x = 64) in;

void main() {
    openLane(kRoofLaneWords);
    uint count = shapesToDerive();
    for (uint i = gl_GlobalInvocationID.x; i < count; i += gl_NumWorkGroups.x * gl_WorkGroupSize.x) deriveShape(i);
}
