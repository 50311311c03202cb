// Reading the indirection geometry image between texels: position and Jacobian under a texture coordinate,
// from texels of one chart only (Buron 2015 §4; a read that mixes charts ruins the walk).
#ifndef ESPALIER_SHARED_SURFACE_LOOKUP_H
#define ESPALIER_SHARED_SURFACE_LOOKUP_H
#include "shaders/shared/exact.h"
#include "shaders/shared/surface_records.h"

ESPALIER_BEGIN

// The surface near one texture coordinate. Object space, metres.
struct Patch {
    vec3 position;
    vec3 du, dv;     // dP/du, dP/dv: metres per unit of UV
    vec3 normal;     // unit, outward
    uint bits;       // Texel::bits of the nearest texel of the chart
    bool beside;     // it isn't creased, but another of the four around is
};

// Reads of a surface's record and arrays.
FN float surfaceScale(SurfaceBuf surfaces, uint instance) { return surfaces.v[instance].scale; }
FN float surfaceRadius(SurfaceBuf surfaces, uint instance) { return surfaces.v[instance].radius; }
FN uint levelSize(SurfaceBuf surfaces, uint instance, uint level) { return surfaces.v[instance].levels[level].size; }
FN Texel readTexel(SurfaceBuf surfaces, uint instance, uint level, uint i) {
    if (surfaces.v[instance].levels[level].touched != 0u)
        return surfaces.v[instance].levels[level].texelTiles.v[i >> 6u].v[i & 63u];
    return surfaces.v[instance].levels[level].texels.v[i];
}
FN uint readTriangle(SurfaceBuf surfaces, uint instance, uint level, uint i) {
    return surfaces.v[instance].levels[level].aux.v[i].triangle;
}
FN uint readHead(SurfaceBuf surfaces, uint instance, uint level, uint i) {
    if (surfaces.v[instance].levels[level].touched != 0u)
        return surfaces.v[instance].levels[level].headTiles.v[i >> 6u].v[i & 63u];
    return surfaces.v[instance].levels[level].crossingHead.v[i];
}
FN uint readRef(SurfaceBuf surfaces, uint instance, uint level, uint i) {
    return surfaces.v[instance].levels[level].crossingRefs.v[i];
}
FN Crossing readCrossing(SurfaceBuf surfaces, uint instance, uint i) { return surfaces.v[instance].crossings.v[i]; }
FN TrianglePlane readPlane(SurfaceBuf surfaces, uint instance, uint i) { return surfaces.v[instance].triangles.v[i]; }
FN void readChart(SurfaceBuf surfaces, uint instance, uint i, OUT(float) orientation, OUT(uint) coarsest) {
    orientation = surfaces.v[instance].charts.v[i].orientation;
    coarsest = surfaces.v[instance].charts.v[i].coarsestLevel;
}

// Rows and columns of texelIndex apart: the four texels of a cell share them.
FN uint texelRow(uint size, uint y) { return (((y >> 3u) * (size >> 3u)) << 6u) + ((y & 7u) << 3u); }
FN uint texelColumn(uint x) { return ((x >> 3u) << 6u) + (x & 7u); }

FN bool texelOwned(uint bits, uint chart) { return ((bits & 0x30000u) != 0u ? bits & 0xFFFFu : kNoIndex) == chart; }

// v kept to [0, high]; NaN becomes 0.
FN float inRange(float v, float high) {
    float c = v > 0.0f ? v : 0.0f;
    return c < high ? c : high;
}

// The texel whose square holds uv (clamped to the image).
FN uint texelAt(uint size, vec2 uv) {
    float last = float(size) - 1.0f;
    uint x = uint(inRange(uv.x * float(size), last));
    uint y = uint(inRange(uv.y * float(size), last));
    return texelRow(size, y) + texelColumn(x);
}

// The four texels around a texture coordinate: their indices, and how far it lies from the first to the last. fsize: the
// level's, a whole number.
struct Cell {
    uint at00, at10, at01, at11;
    float fx, fy;        // [-1, 2]
};
FN Cell cellAt(float fsize, vec2 uv) {
    uint size = uint(fsize);
    float gx = uv.x * fsize - 0.5f;
    float gy = uv.y * fsize - 0.5f;
    uint x = uint(inRange(gx, fsize - 2.0f));
    uint y = uint(inRange(gy, fsize - 2.0f));
    uint c0 = texelColumn(x);
    uint c1 = texelColumn(x + 1u);
    uint r0 = texelRow(size, y);
    uint r1 = texelRow(size, y + 1u);
    Cell c = {};
    c.at00 = r0 + c0;
    c.at10 = r0 + c1;
    c.at01 = r1 + c0;
    c.at11 = r1 + c1;
    c.fx = limited(gx - float(x), -1.0f, 2.0f);
    c.fy = limited(gy - float(y), -1.0f, 2.0f);
    return c;
}

// The bilinear patch of a cell.
struct CellBlend {
    vec3 position, du, dv;
    uint nearest;        // index of the nearest texel of the chart; kNoIndex: none
    uint bits;           // its Texel::bits
    bool own;            // all four are the chart's
    bool creased;        // one of them is
    bool valid;          // there is something at uv
};
FN CellBlend blendOf(Cell c, float fsize, uint chart, vec2 uv, Texel t00, Texel t10, Texel t01, Texel t11) {
    float fx = c.fx;
    float fy = c.fy;
    float ex = 1.0f - fx;
    float ey = 1.0f - fy;
    vec3 low = t10.position - t00.position;
    vec3 high = t11.position - t01.position;
    vec3 left = t01.position - t00.position;
    vec3 right = t11.position - t10.position;
    CellBlend b = {};
    b.du = (low * ey + high * fy) * fsize;
    b.dv = (left * ex + right * fx) * fsize;
    b.position = t00.position + low * (fx * ey) + (left + high * fx) * fy;

    // The nearest texel of this chart, and whether all four serve.
    // Which that is is as good as random, so no branch hangs on it.
    bool own00 = texelOwned(t00.bits, chart);
    bool own10 = texelOwned(t10.bits, chart);
    bool own01 = texelOwned(t01.bits, chart);
    bool own11 = texelOwned(t11.bits, chart);
    uint nearest = own00 ? c.at00 : kNoIndex;
    uint bits = own00 ? t00.bits : 0u;
    float best = own00 ? ex * ey : -9.0f;
    float share = own10 ? fx * ey : -9.0f;
    nearest = share > best ? c.at10 : nearest;
    bits = share > best ? t10.bits : bits;
    best = larger(best, share);
    share = own01 ? ex * fy : -9.0f;
    nearest = share > best ? c.at01 : nearest;
    bits = share > best ? t01.bits : bits;
    best = larger(best, share);
    share = own11 ? fx * fy : -9.0f;
    nearest = share > best ? c.at11 : nearest;
    bits = share > best ? t11.bits : bits;
    b.nearest = nearest;
    b.bits = bits;
    b.own = own00 && own10 && own01 && own11;
    b.creased = texelCrease(t00.bits | t10.bits | t01.bits | t11.bits);
    b.valid = nearest != kNoIndex && absolute(uv.x - 0.5f) <= 0.5f && absolute(uv.y - 0.5f) <= 0.5f;
    return b;
}

// Where the blend won't do: the plane of the triangle under the nearest texel of the chart.
FN bool needsPlane(CellBlend b) { return b.valid && (b.creased || !b.own); }
FN void takePlane(SurfaceBuf surfaces, uint instance, uint level, vec2 uv, INOUT(CellBlend) b) {
    uint triangle = readTriangle(surfaces, instance, level, b.nearest);
    b.valid = triangle != kNoIndex || b.own;
    if (triangle != kNoIndex) {
        TrianglePlane plane = readPlane(surfaces, instance, triangle);
        vec2 offset = uv - plane.uv0;
        b.du = plane.du;
        b.dv = plane.dv;
        b.position = plane.position + plane.du * offset.x + plane.dv * offset.y;
    }
}

// The patch that a blend, or what has been taken in its stead, makes. False: none.
FN bool patchFrom(CellBlend b, float orientation, OUT(Patch) p) {
    vec3 across = cross3(b.du, b.dv);
    float area2 = dot3(across, across);
    p.position = b.position;
    p.du = b.du;
    p.dv = b.dv;
    p.normal = across * (orientation * rsqrtExact(area2));
    p.bits = b.bits;
    p.beside = b.creased && !texelCrease(b.bits);
    return b.valid && area2 > 1e-36f;
}

// Position, Jacobian and normal at uv of `chart` (whose Chart::orientation the caller has at hand). The bilinear
// patch of the four texels around uv; where one of them is creased or belongs elsewhere, the plane of the
// triangle under the nearest texel of the chart. False: no texel of the chart within reach, p is unchanged
// but for values that nobody may use. Reads 4 texels, and a triangle in creased cells.
FN bool patchAt(SurfaceBuf surfaces, uint instance, uint level, uint chart, float orientation, vec2 uv, OUT(Patch) p) {
    float size = float(levelSize(surfaces, instance, level));
    Cell c = cellAt(size, uv);
    Texel t00 = readTexel(surfaces, instance, level, c.at00);
    Texel t10 = readTexel(surfaces, instance, level, c.at10);
    Texel t01 = readTexel(surfaces, instance, level, c.at01);
    Texel t11 = readTexel(surfaces, instance, level, c.at11);
    CellBlend b = blendOf(c, size, chart, uv, t00, t10, t01, t11);
    if (needsPlane(b)) takePlane(surfaces, instance, level, uv, b);
    return patchFrom(b, orientation, p);
}

// Position, du and dv at uv, on the level asked for or the chart's coarsest. False as for patchAt.
FN bool surfaceAt(SurfaceBuf surfaces, uint instance, uint level, uint chart, vec2 uv, OUT(vec3) position,
                  OUT(vec3) du, OUT(vec3) dv) {
    uint coarsest = surfaces.v[instance].charts.v[chart].coarsestLevel;
    Patch p = {};
    bool found = patchAt(surfaces, instance, level < coarsest ? level : coarsest, chart, 1.0f, uv, p);
    position = p.position;
    du = p.du;
    dv = p.dv;
    return found;
}

// The interpolated shading normal stored at the texel nearest to uv. Unit, outward.
FN vec3 normalAt(SurfaceBuf surfaces, uint instance, uint level, vec2 uv) {
    uint size = surfaces.v[instance].levels[level].size;
    return unpackOct(surfaces.v[instance].levels[level].aux.v[texelAt(size, uv)].normal);
}

// Curvature (1/m of object space, positive on bulges) at the texel nearest to uv.
FN float curvatureAt(SurfaceBuf surfaces, uint instance, uint level, vec2 uv) {
    uint size = levelSize(surfaces, instance, level);
    uint bits = readTexel(surfaces, instance, level, texelAt(size, uv)).bits;
    return decodeCurvature(bits, rcpExact(surfaceRadius(surfaces, instance)));
}

ESPALIER_END
#endif
