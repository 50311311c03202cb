#version 460
#extension GL_GOOGLE_include_directive : require
// The cells of each row that a grid's region touches; see roof_cells.h.
#include "shaders/shared/extensions.glsl"

#define ESPALIER_ROOF_FETCH
layout(constant_id = 2) const uint kRecordsByAddress = 1u;
layout(binding = 1) uniform usamplerBuffer gridTexels;
layout(binding = 2) uniform usamplerBuffer regionTexels;
layout(binding = 3) uniform usamplerBuffer partTexels;
layout(binding = 4) uniform usamplerBuffer planeTexels;
#define GRID_TEXEL(i) texelFetch(gridTexels, int(i))
#define REGION_TEXEL(i) texelFetch(regionTexels, int(i))
#define PART_TEXEL(i) texelFetch(partTexels, int(i))
#define PLANE_TEXEL(i) texelFetch(planeTexels, int(i))
#include "shaders/shared/roof_cells.h"

layout(local_size_x = 64) in;
layout(binding = 0, scalar) uniform Environment { RoofEnv environment; };

shared uint sums[2];

void main() {
    RoofEnv env = environment;
    if (gl_LocalInvocationID.x == 0u) {
        sums[0] = 0u;
        sums[1] = 0u;
    }
    barrier();
    uint i = env.firstGrid + gl_GlobalInvocationID.x;
    bool room = env.status.v[0].grids <= env.gridRoom && env.status.v[0].rows <= env.rowRoom;
    if (room && i < env.status.v[0].grids) {
        uvec2 cells = gridRuns(env, i);
        atomicAdd(sums[0], cells.x);
        atomicAdd(sums[1], cells.y);
    }
    barrier();
    if (gl_LocalInvocationID.x == 0u) {
        atomicAdd(env.status.v[0].touched, sums[0]);
        atomicAdd(env.status.v[0].whole, sums[1]);
    }
}
