#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/extensions.glsl"
// A ring of bark each: its frame once, then its twelve vertices in one run of memory.
#include "shaders/emit/bark_ring.h"
#include "shaders/emit/instance_texels.glsl"
#include "shaders/emit/triangle_vertex.glsl"
#include "shaders/shared/dispatch.glsl"

layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Data { TrianglesPush push; };
layout(set = 0, binding = 0) uniform usamplerBuffer spanTexels;
layout(set = 0, binding = 1) uniform usamplerBuffer drawn;

void writePair(U64Buf ring, uint i, BarkRing r, float across, float upward) {
    BarkPair p = barkPair(r, across, upward);
    writeVertex(ring, i, r.center + p.arm, p.ahead);
    writeVertex(ring, i + 6u, r.center - p.arm, p.behind);
}

void main() {
    uint i = itemIndex();
    uint spanIndex = i / kBarkRings;
    uint ring = i - spanIndex * kBarkRings;
    if (spanIndex >= push.count) return;
    SpanInstance o = SPAN_INSTANCE(spanTexels, TEXEL(drawn, push.firstInstance + spanIndex).x);
    BarkRing r = barkRing(o, unpackOct(o.normal0), unpackOct(o.normal1), ring);
    if (roundedTip(o)) r.radius = tipRadius(o, ring);
    U64Buf out0 = vertexAddress(push.vertices, push.firstVertex + spanIndex * kBarkVertices + ring * kBarkSides);
    writePair(out0, 0u, r, 1.0, 0.0);
    writePair(out0, 1u, r, kBarkCosine, 0.5);
    writePair(out0, 2u, r, 0.5, kBarkCosine);
    writePair(out0, 3u, r, 0.0, 1.0);
    writePair(out0, 4u, r, -0.5, kBarkCosine);
    writePair(out0, 5u, r, -kBarkCosine, 0.5);
}
