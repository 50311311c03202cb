#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_KHR_shader_subgroup_arithmetic : require
#extension GL_KHR_shader_subgroup_ballot : require
// Shapes of one wave -> shapes of the next, grids of terminals with their rows; see roof_expand.h.
#include "shaders/shared/extensions.glsl"

#include "shaders/shared/constants.h"
#define ESPALIER_ROOF_FETCH
layout(constant_id = kConstantRecordsByAddress) const uint kRecordsByAddress = 1u;
layout(binding = 3) uniform usamplerBuffer atomTexels;
layout(binding = 4) uniform usamplerBuffer regionTexels;
layout(binding = 5) uniform usamplerBuffer pieceTexels;
layout(binding = 6) uniform usamplerBuffer shapeTexels;
layout(binding = 7) uniform usamplerBuffer partTexels;
layout(binding = 8) uniform usamplerBuffer planeTexels;
#define ATOM_TEXEL(view, i) texelFetch(atomTexels, int(i))
#define REGION_TEXEL(view, i) texelFetch(regionTexels, int(i))
#define PIECE_TEXEL(view, i) texelFetch(pieceTexels, int(i))
#define SHAPE_TEXEL(view, i) texelFetch(shapeTexels, int(i))
#define PART_TEXEL(view, i) texelFetch(partTexels, int(i))
#define PLANE_TEXEL(view, i) texelFetch(planeTexels, int(i))
#include "shaders/shared/roof_expand.h"

layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { uint wave; };

void main() {
    RoofEnv env = roofEnv;
    env.wave = wave;
    if ((wave & 1u) != 0u) {
        env.shapes = roofEnv.next;
        env.next = roofEnv.shapes;
    }
    uint i = gl_GlobalInvocationID.x;
    RoofTally tally = emptyTally();
    if (i < shapesToDerive(env)) deriveShape(env, i, tally);
    addTally(env, tally);
}
