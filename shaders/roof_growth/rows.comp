#version 460
#extension GL_GOOGLE_include_directive : require
// Grids of an expansion -> the runs of their rows, and what they come to; see roof_rows.h.
#include "shaders/shared/extensions.glsl"
#include "shaders/shared/roof_rows.h"

layout(local_size_x = 64) in;
layout(binding = 0, scalar) uniform Environment { RoofEnv env; };

void main() {
    finishGrids(env, gl_GlobalInvocationID.x, gridsToFinish(env), gl_NumWorkGroups.x * gl_WorkGroupSize.x);
}
