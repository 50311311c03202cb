// Growth's records -> the span that ends at a node, in the world (Buron 2015 §6).
#ifndef ESPALIER_EMIT_SPAN_LOAD_H
#define ESPALIER_EMIT_SPAN_LOAD_H
#include "shaders/emit/emit_records.h"
#include "shaders/shared/bezier.h"

ESPALIER_BEGIN

CONST_FLOAT(kBarkRise, 0.45f);     // the bark's axis lies this many radii above the surface: its back is buried
CONST_FLOAT(kChildFlare, 1.12f);   // a child's radius where it leaves its parent

struct LoadedSpan {
    Span span;
    vec3 normal0, normal1;     // unit, world
    float radius0, radius1;    // metres
    float arc0;
    bool valid;                // false: no span ends here
    bool tip;
};

// Rows times point or direction; spelled out, because C++ and GLSL name matrices differently.
FN vec3 placePoint(vec4 r0, vec4 r1, vec4 r2, vec3 p) {
    return vec3(r0.x * p.x + r0.y * p.y + r0.z * p.z + r0.w, r1.x * p.x + r1.y * p.y + r1.z * p.z + r1.w,
                r2.x * p.x + r2.y * p.y + r2.z * p.z + r2.w);
}
FN vec3 placeDirection(vec4 r0, vec4 r1, vec4 r2, vec3 d) {
    return unit3(vec3(r0.x * d.x + r0.y * d.y + r0.z * d.z, r1.x * d.x + r1.y * d.y + r1.z * d.z,
                      r2.x * d.x + r2.y * d.y + r2.z * d.z));
}

// The node that the span of node `i` starts from, or kNoIndex.
FN uint previousNode(ChunkBuf chunks, Node node, uint i) {
    return ((node.flags >> 8u) & 31u) > 0u ? i - 1u : chunks.v[node.chunk].previousNode;
}

// The span from node `a` to node `b` of the surface instances with these rows. foot: it begins at a seed.
FN LoadedSpan spanBetween(Node a, Node b, bool sameBranch, bool foot, vec4 a0, vec4 a1, vec4 a2, vec4 b0, vec4 b1,
                          vec4 b2) {
    LoadedSpan s;
    vec3 p0 = placePoint(a0, a1, a2, a.position);
    vec3 p3 = placePoint(b0, b1, b2, b.position);
    vec3 t0 = placeDirection(a0, a1, a2, unpackOct(a.tangent));
    vec3 t3 = placeDirection(b0, b1, b2, unpackOct(b.tangent));
    s.normal0 = placeDirection(a0, a1, a2, unpackOct(a.normal));
    s.normal1 = placeDirection(b0, b1, b2, unpackOct(b.normal));

    s.radius1 = b.radius;
    s.radius0 = sameBranch && a.radius > 0.0f ? a.radius : b.radius * kChildFlare;
    if (!sameBranch && a.radius > 0.0f) s.radius0 = smaller(s.radius0, a.radius);
    s.arc0 = sameBranch ? a.arc : 0.0f;

    uint smoothness = (b.flags >> 15u) & 3u;
    if (smoothness == kSmoothC1) {
        s.span = levelSpan(smoothSpan(p0, t0, p3, t3), t0, s.normal0, (a.flags & kNodeInserted) != 0u, t3, s.normal1,
                           (b.flags & kNodeInserted) != 0u, 0.5f * smaller(s.radius0, s.radius1));
    } else if (smoothness == kSmoothC0) {
        // Handles just long enough to turn the rings at the joints into the mitre; the rest is straight.
        float handle = 0.02f * length3(p3 - p0);
        s.span.p0 = p0;
        s.span.b1 = p0 + t0 * handle;
        s.span.b2 = p3 - t3 * handle;
        s.span.p3 = p3;
    } else {
        s.span = straightSpan(p0, p3);
    }
    // A seed's first span starts below the ground, so that no open end shows.
    if (foot) s.span.p0 = p0 - t0 * (1.5f * s.radius0);
    s.tip = (b.flags & kNodeTip) != 0u;
    s.valid = true;
    return s;
}

FN LoadedSpan loadSpan(NodeBuf nodes, ChunkBuf chunks, SurfaceBuf surfaces, uint i) {
    LoadedSpan none;
    none.valid = false;
    Node b = nodes.v[i];
    uint before = previousNode(chunks, b, i);
    if (before == kNoIndex) return none;
    Node a = nodes.v[before];
    bool sameBranch = a.chunk == b.chunk || chunks.v[a.chunk].branch == chunks.v[b.chunk].branch;
    bool foot = sameBranch && ((a.flags >> 8u) & 31u) == 0u && chunks.v[a.chunk].previousNode == kNoIndex;
    uint ia = a.place >> 16u;
    uint ib = b.place >> 16u;
    return spanBetween(a, b, sameBranch, foot, surfaces.v[ia].toWorld[0], surfaces.v[ia].toWorld[1],
                       surfaces.v[ia].toWorld[2], surfaces.v[ib].toWorld[0], surfaces.v[ib].toWorld[1],
                       surfaces.v[ib].toWorld[2]);
}

// Radius at u: between the nodes', drawn in to a half sphere at a branch's end. length: of the span.
FN float barkRadius(float radius0, float radius1, float length, bool tip, float u) {
    float radius = radius0 * (1.0f - u) + radius1 * u;
    if (!tip) return radius;
    float cap = limited(divExact(radius1, larger(length, 1e-9f)), 1e-4f, 0.5f);
    float x = divExact(u - (1.0f - cap), cap);
    return x > 0.0f ? radius * sqrtExact(larger(1.0f - x * x, 0.0f)) : radius;
}

ESPALIER_END
#endif
