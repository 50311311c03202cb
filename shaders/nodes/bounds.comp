#version 460
#extension GL_GOOGLE_include_directive : require
// Geometry and a program -> a box around it.
#include "shaders/shared/extensions.glsl"
#include "shaders/shared/dispatch.glsl"
#include "shaders/shared/node_bounds.h"

layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Data { BoundArgs a; };

void main() {
    uint i = itemIndex();
    if (i >= a.items) return;
    vec3 p = boundPlace(a, i);
    for (uint k = 0u; k < 3u; ++k) {
        atomicMin(a.box.v[k], orderedBits(p[k]));
        atomicMax(a.box.v[3u + k], orderedBits(p[k]));
    }
}
