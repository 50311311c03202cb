// The triangle under a texture coordinate, told from the texels around it and its corners; the way out of it. patchAt
// takes the nearest texel's triangle, which near a crease is wrong by up to half a texel: enough for a walk, not for
// thin bark that lies there.
#ifndef ESPALIER_SHARED_TRIANGLE_LOOKUP_H
#define ESPALIER_SHARED_TRIANGLE_LOOKUP_H
#include "shaders/shared/surface_lookup.h"

ESPALIER_BEGIN

// The point of a -> b that is nearest to uv.
FN vec2 nearestOnEdge(vec2 a, vec2 b, vec2 uv) {
    vec2 e = b - a;
    return a + e * limited(dot2(uv - a, e) * rcpExact(larger(dot2(e, e), 1e-30f)), 0.0f, 1.0f);
}

FN bool isInside(TrianglePlane t, vec2 uv) {
    float a = cross2(t.uv1 - t.uv0, uv - t.uv0);
    float b = cross2(t.uv2 - t.uv1, uv - t.uv1);
    float c = cross2(t.uv0 - t.uv2, uv - t.uv2);
    return smaller(a, smaller(b, c)) >= 0.0f || larger(a, larger(b, c)) <= 0.0f;
}

// The point of the triangle that is nearest to uv.
FN vec2 nearestInside(TrianglePlane t, vec2 uv) {
    vec2 nearest = uv;
    if (!isInside(t, uv)) {
        nearest = nearestOnEdge(t.uv0, t.uv1, uv);
        vec2 b = nearestOnEdge(t.uv1, t.uv2, uv);
        vec2 c = nearestOnEdge(t.uv2, t.uv0, uv);
        nearest = dot2(b - uv, b - uv) < dot2(nearest - uv, nearest - uv) ? b : nearest;
        nearest = dot2(c - uv, c - uv) < dot2(nearest - uv, nearest - uv) ? c : nearest;
    }
    return nearest;
}

// The square of the distance in UV from the triangle to uv, 0 inside.
FN float outsideOf(TrianglePlane t, vec2 uv) {
    vec2 apart = nearestInside(t, uv) - uv;
    return dot2(apart, apart);
}

// The point of the triangle at uv, or at what is nearest to uv: where the triangles between are so small that no texel
// names them, uv lies outside, and the triangle's plane would lead off the mesh.
FN vec3 pointOn(TrianglePlane t, vec2 uv) {
    vec2 offset = nearestInside(t, uv) - t.uv0;
    return t.position + t.du * offset.x + t.dv * offset.y;
}

// The share of the way uv -> uv + delta after which it leaves the triangle that it begins in; 2: it doesn't. Shares are
// compared as fractions, so that there is one division.
FN float shareInside(TrianglePlane t, vec2 uv, vec2 delta) {
    vec2 e0 = t.uv1 - t.uv0;
    vec2 e1 = t.uv2 - t.uv1;
    vec2 e2 = t.uv0 - t.uv2;
    float turn = sign1(cross2(e0, e1));
    float left = 2.0f;
    float pace = 1.0f;
    float p = -cross2(e0, delta) * turn;
    float l = larger(cross2(e0, uv - t.uv0) * turn, 0.0f);
    bool nearer = l * pace < left * p;
    left = nearer ? l : left;
    pace = nearer ? p : pace;
    p = -cross2(e1, delta) * turn;
    l = larger(cross2(e1, uv - t.uv1) * turn, 0.0f);
    nearer = l * pace < left * p;
    left = nearer ? l : left;
    pace = nearer ? p : pace;
    p = -cross2(e2, delta) * turn;
    l = larger(cross2(e2, uv - t.uv2) * turn, 0.0f);
    nearer = l * pace < left * p;
    left = nearer ? l : left;
    pace = nearer ? p : pace;
    return left * rcpExact(pace);
}

// Of the chart's triangles that texels around uv name the one under uv, or else the one nearest to it; kNoIndex: there
// is none, and `found` is of no use. The four texels are asked, nearest first, and where uv is in none of theirs (on an
// edge by rounding, or none of the four is of its triangle) distances decide, to these and to those around.
FN uint triangleUnder(SurfaceBuf surfaces, uint place, vec2 uv, OUT(TrianglePlane) found) {
    uint instance = place >> 16u;
    uint chart = place & 0xFFFFu;
    uint size = levelSize(surfaces, instance, 0u);
    float gx = uv.x * float(size) - 0.5f;
    float gy = uv.y * float(size) - 0.5f;
    uint x = uint(inRange(gx, float(size) - 2.0f));
    uint y = uint(inRange(gy, float(size) - 2.0f));
    uint nearest = (gx - float(x) >= 0.5f ? 1u : 0u) | (gy - float(y) >= 0.5f ? 2u : 0u);
    float least = 4.0f;   // the UV square has no such distance
    uint known = kNoIndex;
    uint tried = kNoIndex;
    uint k = 0u;
    do {   // software devices go through a body once more where the test comes first
        bool close = k < 4u;
        uint cx = x + (close ? (nearest ^ k) & 1u : k & 3u) - (close ? 0u : 1u);
        uint cy = y + (close ? (nearest ^ k) >> 1u : k >> 2u) - (close ? 0u : 2u);
        if (cx >= size || cy >= size) continue;
        uint triangle = readTriangle(surfaces, instance, 0u, texelRow(size, cy) + texelColumn(cx));
        if (triangle == tried || triangle == kNoIndex) continue;
        tried = triangle;
        TrianglePlane plane = readPlane(surfaces, instance, triangle);
        if (plane.chart != chart) continue;
        float outside = close ? (isInside(plane, uv) ? 0.0f : 4.0f) : outsideOf(plane, uv);
        if (outside < least) {
            least = outside;
            known = triangle;
            found = plane;
        }
    } while (++k < 20u && least > 0.0f);
    return known;
}

ESPALIER_END
#endif
