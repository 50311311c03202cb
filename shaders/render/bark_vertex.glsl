// Bends a terminal mesh along its span (Buron 2015 §6): x and y in radii across, z along.
#ifndef ESPALIER_RENDER_BARK_VERTEX_GLSL
#define ESPALIER_RENDER_BARK_VERTEX_GLSL
#include "shaders/emit/span_load.h"
#include "shaders/emit/triangle_vertex.glsl"
#include "shaders/render/drawn.glsl"
#include "shaders/render/frame.glsl"

// Across a span at a place on it: the curve, what lies across, how thick it is.
struct DrawnRing {
    vec3 center, side, up, tangent;   // the tangent isn't of unit length
    float radius;
};

struct BarkVertex {
    SpanInstance span;
    vec3 position, normal;
    float around, metres;   // along the branch
    float radius;
};

// u: along the span, 0 to 1. ribbon: across the view, its normal towards the eye.
DrawnRing drawnRing(SpanInstance o, float u, bool ribbon) {
    float w = 1.0 - u;
    Span span = Span(o.p0, o.b1, o.b2, o.p3);
    vec3 center = spanPoint(span, u);
    vec3 tangent = spanVelocity(span, u);
    vec3 up = octahedralToUnit(o.normal0) * w + octahedralToUnit(o.normal1) * u;
    vec3 side = cross(up, tangent);
    side *= inversesqrt(max(dot(side, side), 1e-30));
    up = cross(tangent, side);
    up *= inversesqrt(max(dot(up, up), 1e-30));
    if (ribbon) {
        vec3 toEye = frame.eye - center;
        side = cross(toEye, tangent);
        side *= inversesqrt(max(dot(side, side), 1e-30));
        vec3 facing = cross(tangent, side);
        up = normalize(up + facing * inversesqrt(max(dot(facing, facing), 1e-30)));
    }
    float radius = o.radius0 * w + o.radius1 * u;
    center += up * (kBarkRise * radius);
    if ((o.bits & 256u) != 0u) radius = barkRadius(o.radius0, o.radius1, o.metres, true, u);
    return DrawnRing(center, side, up, tangent, radius);
}

BarkVertex barkVertex(TerminalPush push, uint vertex, uint drawn) {
    uint instance = vertex / push.vertexCount;
    uint local = vertex - instance * push.vertexCount;
    instance += drawn * push.batch;
    BarkVertex v;
    SpanInstance o = drawnSpan(state.starts[push.bucket] + instance);
    TerminalVertex mesh = drawnVertex(push.firstVertex + local);
    float u = clamp(mesh.position.z, 0.0, 1.0);
    DrawnRing ring = drawnRing(o, u, push.vertexCount == kRibbonVertices);
    v.position = ring.center + (ring.side * mesh.position.x + ring.up * mesh.position.y) * ring.radius;
    vec3 n = octahedralToUnit(mesh.normal);
    v.normal = ring.side * n.x + ring.up * n.y + normalize(ring.tangent + vec3(1e-12)) * n.z;
    v.span = o;
    v.around = mesh.uv.x;
    v.metres = o.arc0 + o.metres * u;
    v.radius = ring.radius;
    return v;
}

float barkFade(SpanInstance span) { return float(span.bits >> 16u) * (1.0 / 65535.0); }
// Above bit 7 differs between spans; below as SpanInstance::bits.
uint barkHash(SpanInstance span) {
    uint hash = (span.normal0 ^ floatBitsToUint(span.p0.x)) * 0x9E3779B1u;
    return (hash & ~255u) | (span.bits & 255u);
}
#endif
