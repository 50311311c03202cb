// The triangle under a texture coordinate, told from the four texels around it. patchAt takes the nearest texel's
// triangle, which near a crease is wrong by up to half a texel: enough for a walk, not for thin bark that lies there.
#ifndef ESPALIER_SHARED_TRIANGLE_LOOKUP_H
#define ESPALIER_SHARED_TRIANGLE_LOOKUP_H
#include "shaders/shared/surface_lookup.h"

ESPALIER_BEGIN

// position: the point of that triangle under uv, on the finest level. normal: its unit normal, on the side of what it
// was. Both stay as they are where no texel has a triangle.
//
// Two triangles' planes, as maps of uv, agree along their common edge alone. Its sides are told apart by the texels
// whose triangles they are, since these lie inside them: no corner of a triangle need be read.
FN void seatOnTriangle(SurfaceBuf surfaces, uint place, vec2 uv, INOUT(vec3) position, INOUT(vec3) normal) {
    uint instance = place >> 16u;
    uint chart = place & 0xFFFFu;
    uint size = levelSize(surfaces, instance, 0u);
    float texel = rcpExact(float(size));
    float gx = uv.x * float(size) - 0.5f;
    float gy = uv.y * float(size) - 0.5f;
    uint x = uint(inRange(gx, float(size) - 2.0f));
    uint y = uint(inRange(gy, float(size) - 2.0f));
    uint nearest = (gx - float(x) >= 0.5f ? 1u : 0u) | (gy - float(y) >= 0.5f ? 2u : 0u);
    // The triangle found so far: du and dv, its plane's point under uv, its texel's centre seen from uv.
    vec3 du = vec3(0.0f);
    vec3 dv = vec3(0.0f);
    vec3 point = position;
    vec2 inside = vec2(0.0f);
    uint known = kNoIndex;
    for (uint k = 0u; k < 4u; ++k) {
        uint cx = x + ((nearest ^ k) & 1u);
        uint cy = y + ((nearest ^ k) >> 1u);
        uint at = texelRow(size, cy) + texelColumn(cx);
        uint triangle = readTriangle(surfaces, instance, 0u, at);
        if (triangle == known) continue;   // or none, at first
        if (!texelOwned(readTexel(surfaces, instance, 0u, at).bits, chart) || triangle == kNoIndex) continue;
        TrianglePlane plane = readPlane(surfaces, instance, triangle);
        vec2 offset = uv - plane.uv0;
        vec3 here = plane.position + plane.du * offset.x + plane.dv * offset.y;
        vec2 center = vec2((float(cx) + 0.5f) * texel, (float(cy) + 0.5f) * texel) - uv;
        // How far the planes are apart under uv and under both texels' centres.
        vec3 apart = point - here;
        vec3 ddu = du - plane.du;
        vec3 ddv = dv - plane.dv;
        vec3 apartThere = apart + ddu * center.x + ddv * center.y;
        vec3 apartInside = apart + ddu * inside.x + ddv * inside.y;
        bool closer = dot3(apartThere, apartInside) < 0.0f && dot3(apartThere, apart) > 0.0f;
        if (closer || known == kNoIndex) {
            du = plane.du;
            dv = plane.dv;
            point = here;
            inside = center;
            known = triangle;
        }
    }
    vec3 across = cross3(du, dv);
    float area2 = dot3(across, across);
    if (known == kNoIndex || !(area2 > 1e-36f)) return;
    across = across * rsqrtExact(area2);
    position = point;
    normal = dot3(across, normal) < 0.0f ? -across : across;
}

ESPALIER_END
#endif
