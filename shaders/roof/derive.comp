#version 460
#extension GL_GOOGLE_include_directive : require
// Shapes of one wave -> shapes of the next, grids of terminals; see roof_expand.h.
#include "shaders/shared/extensions.glsl"
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
    if (i < min(env.waves.v[wave].count, env.shapeRoom)) deriveShape(env, i);
}
