#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/extensions.glsl"
// A ring of bark each: its frame once, then its twelve vertices in one run of memory.
#include "shaders/emit/instance_texels.glsl"
#include "shaders/emit/span_load.h"
#include "shaders/emit/triangle_vertex.glsl"
#include "shaders/shared/dispatch.glsl"

layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Data { TrianglesPush push; };
layout(set = 0, binding = 0) uniform usamplerBuffer spanTexels;
layout(set = 0, binding = 1) uniform usamplerBuffer drawn;

// Snorm bits of both numbers, rounded; the bias that makes them positive falls away.
uint snormBits(vec2 p) {
    uvec2 q = uvec2(p * 32767.0 + 65536.5);
    return (q.x & 0xFFFFu) | (q.y << 16u);
}

// Two opposite vertices. Exactly one of n and -n lies on the folded half of the octahedron, and the fold is odd:
// one projection and one fold serve both.
void writePair(U64Buf ring, uint side, vec3 center, vec3 n, float radius) {
    float k = 1.0 / (abs(n.x) + abs(n.y) + abs(n.z));
    vec2 p = n.xy * k;
    vec2 folded = vec2(p.x < 0.0 ? abs(p.y) - 1.0 : 1.0 - abs(p.y), p.y < 0.0 ? abs(p.x) - 1.0 : 1.0 - abs(p.x));
    bool below = n.z < 0.0;
    vec3 arm = n * radius;
    writeVertex(ring, side, center + arm, snormBits(below ? folded : p));
    writeVertex(ring, side + 6u, center - arm, snormBits(below ? -p : -folded));
}

void main() {
    uint i = itemIndex();
    uint spanIndex = i / kBarkRings;
    uint ring = i - spanIndex * kBarkRings;
    if (spanIndex >= push.count) return;
    SpanInstance o = SPAN_INSTANCE(spanTexels, TEXEL(drawn, push.firstInstance + spanIndex).x);
    float u = float(ring) * (1.0 / 9.0);
    float v = 1.0 - u;
    vec3 center = o.p0 * (v * v * v) + o.b1 * (3.0 * v * v * u) + o.b2 * (3.0 * v * u * u) + o.p3 * (u * u * u);
    vec3 along = (o.b1 - o.p0) * (v * v) + (o.b2 - o.b1) * (2.0 * v * u) + (o.p3 - o.b2) * (u * u);
    vec3 normal = octahedralToUnit(o.normal0) * v + octahedralToUnit(o.normal1) * u;
    vec3 side = cross(normal, along);
    side *= inversesqrt(max(dot(side, side), 1e-30));
    vec3 up = cross(along, side);
    up *= inversesqrt(max(dot(up, up), 1e-30));
    float radius = o.radius0 * v + o.radius1 * u;
    center += up * (kBarkRise * radius);
    if ((o.bits & 64u) != 0u) radius = max(barkRadius(o.radius0, o.radius1, o.metres, true, u), 1e-7);

    const float h = 0.8660254;
    U64Buf out0 = vertexAddress(push.vertices, push.firstVertex + spanIndex * kBarkVertices + ring * kBarkSides);
    writePair(out0, 0u, center, side, radius);
    writePair(out0, 1u, center, side * h + up * 0.5, radius);
    writePair(out0, 2u, center, side * 0.5 + up * h, radius);
    writePair(out0, 3u, center, up, radius);
    writePair(out0, 4u, center, up * h - side * 0.5, radius);
    writePair(out0, 5u, center, up * 0.5 - side * h, radius);
}
