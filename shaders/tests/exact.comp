#version 460
// Sums and products that a driver would like to fuse; the host does the same without contraction.
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/extensions.glsl"
#include "shaders/shared/dispatch.glsl"
#include "shaders/shared/exact.h"

layout(local_size_x_id = 0) in;
layout(constant_id = 1) const uint kOffset = 0;
BUFFER(Triples, vec3)
BUFFER(Results, vec4)
layout(push_constant, scalar) uniform Push {
    Triples triples;
    Results results;
    uint count;
};

void main() {
    uint i = itemIndex();
    if (i >= count) return;
    vec3 t = triples.v[i];
    float s, c;
    sinCosExact(t.x * 50.0, s, c);
    results.v[i] = vec4(t.x * t.y + t.z, dot3(t, t.yzx), rsqrtExact(absolute(t.x * t.y)), s * c + float(kOffset));
}
