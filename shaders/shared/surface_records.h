// The indirection geometry image as kernels see it (Buron 2015 §4, with exact seam maps).
//
// A surface has up to kMaxLevels square levels, level 0 the finest. A level is an image over the walk's UV
// square [0,1]²; texel (x, y) of a level of `size` texels has its centre at ((x + .5) / size, (y + .5) / size).
// Texels lie in 8×8 tiles: see texelIndex. Positions are in the surface's object space, in metres.
#ifndef ESPALIER_SHARED_SURFACE_RECORDS_H
#define ESPALIER_SHARED_SURFACE_RECORDS_H
#include "shaders/shared/language.h"

ESPALIER_BEGIN

CONST_UINT(kMaxLevels, 8u);
CONST_UINT(kNoIndex, 0xFFFFFFFFu);

// What a texel is. Gutter texels lie outside their chart, next to it: their position is that of the nearest
// triangle's plane carried on, so that a bilinear read at a chart's border needs no foreign texel.
CONST_UINT(kTexelEmpty, 0u);
CONST_UINT(kTexelInner, 1u);   // its centre is in the chart
CONST_UINT(kTexelLink, 2u);    // gutter, next to a border that goes on somewhere
CONST_UINT(kTexelOpen, 3u);    // gutter, next to a border of the model itself

// 16 bytes. bits: 31..24 curvature (decodeCurvature), 23..19 clearance, 18 crease, 17..16 class, 15..0 chart.
//   clearance: a circle of this many texels around the texel's square meets no crossing and no open border;
//              0 to 31, never overstated. A step shorter than it needs no crossing test.
//   crease:    triangles of unlike normals meet within a texel of here: take position and Jacobian from the
//              texel's triangle, not from the bilinear patch.
struct Texel {
    vec3 position;
    uint bits;
};
STATIC_SIZE(Texel, 16);

// 8 bytes; read seldom. normal: octahedral, 2×16 bit snorm, the interpolated shading normal.
// triangle: index into SurfaceRef::triangles, kNoIndex where empty.
struct TexelAux {
    uint normal;
    uint triangle;
};
STATIC_SIZE(TexelAux, 8);

// How a crossing was found.
CONST_UINT(kCrossingSeam, 0u);      // by topology: the edge's twin
CONST_UINT(kCrossingNearest, 1u);   // by nearest points, within a tolerance
CONST_UINT(kCrossingContact, 2u);   // where two pieces touch or run into each other
CONST_UINT(kCrossingOpen, 3u);      // a border of the model: leads nowhere

// A directed piece of border, 48 bytes. Walking over segment a-b to the outside of its chart leads to the
// segment ta-tb of the target chart, by the affine map a -> ta, b -> tb. All UVs are in [0,1]², level-free.
// Bit 2 of flags tells on which side of a -> b, as seen in the UV plane with v up, the chart's inside lies.
// A contact runs through the middle of charts: its inside is the side from which a walk may come. One that leads to
// another instance tells by bits 15..8 of flags how that one's outside is turned there: see crossingJoint.
struct Crossing {
    vec2 a, b;
    vec2 ta, tb;
    uint edge;         // octahedral 2×16: unit 3D direction a -> b on this side
    uint targetEdge;   // octahedral 2×16: unit 3D direction ta -> tb on the other side (same as edge for seams)
    uint target;       // bits 31..16 surface instance (0xFFFF: this one), 15..0 chart
    uint flags;        // bits 1..0 kind, 2 kCrossingInsideLeft, 3 kCrossingTurned, 4 kCrossingMirrored, 15..8 joint,
                       // bits 15..4 in files 0, 31..16 the chart whose border this is (charts may touch in the atlas)
};
STATIC_SIZE(Crossing, 48);
CONST_UINT(kCrossingInsideLeft, 4u);   // the inside is to the left of a -> b
CONST_UINT(kCrossingTurned, 8u);       // leads to the back of a sheet: outward there is inward here
CONST_UINT(kCrossingMirrored, 16u);    // of the two instances one is mirrored: left there is right here

// With x this, n the far side's outside and e the direction of targetEdge, the mean of both sides' outsides points
// along n (1 - |x|) + (e × n) x, in the far instance's object space.
FN float crossingJoint(uint flags) {
    int x = int(flags << 16u) >> 24;
    return float(x) * 0.00787401575f;
}
FN uint packCrossingJoint(float x) { return (uint(int(x * 127.0f + (x < 0.0f ? -0.5f : 0.5f))) & 255u) << 8u; }

// 40 bytes. orientation: +1 or -1, so that orientation * cross(P_u, P_v) points outward (mirrored: -1).
struct Chart {
    vec2 uvMin, uvMax;
    float orientation;
    uint coarsestLevel;    // the last level on which this chart can be walked
    float area;            // m²
    float metresPerUv;     // sqrt(area / area in UV)
    uint firstTriangle;    // triangles are sorted by chart
    uint triangleCount;
};
STATIC_SIZE(Chart, 40);

// The affine map of one triangle, 64 bytes: P(uv) = position + du * (uv.x - uv0.x) + dv * (uv.y - uv0.y). Its corners
// in UV are uv0, uv1, uv2, either way around.
struct TrianglePlane {
    vec3 position, du, dv;
    vec2 uv0;
    uint chart;
    vec2 uv1, uv2;
};
STATIC_SIZE(TrianglePlane, 64);

BUFFER(TexelBuf, Texel)
BUFFER(TexelAuxBuf, TexelAux)
BUFFER(UintBuf, uint)
BUFFER(FloatBuf, float)
BUFFER(CrossingBuf, Crossing)
BUFFER(ChartBuf, Chart)
BUFFER(TrianglePlaneBuf, TrianglePlane)
// Of each 8x8 tile, where its texels or their heads lie.
BUFFER(TexelTiles, TexelBuf)
BUFFER(HeadTiles, UintBuf)

// One level, 56 bytes. crossingHead: one word a texel, bits 31..8 first index into crossingRefs, 7..0 count;
// crossingRefs: indices into SurfaceRef::crossings of the segments that pass the texel's square (grown by a
// hundredth of a texel), inner texels and gutter texels alike.
// Placements of one surface share its arrays. Where others touch a placement, some tiles are its own: then its lists and
// crossings are, too, and texels and heads are found by tile.
struct SurfaceLevel {
    TexelBuf texels;           // as baked, as is crossingHead
    TexelAuxBuf aux;
    UintBuf crossingHead;
    UintBuf crossingRefs;
    TexelTiles texelTiles;     // [size² / 64] each, of those that are touched
    HeadTiles headTiles;
    uint size;
    uint touched;              // 1: by another placement
};
STATIC_SIZE(SurfaceLevel, 56);

// One surface instance. scale: metres in the world per object-space unit (instances scale evenly only);
// the walk counts lengths in world metres.
struct SurfaceRef {
    SurfaceLevel levels[8];
    CrossingBuf crossings;
    ChartBuf charts;
    TrianglePlaneBuf triangles;
    uint levelCount;
    uint chartCount;
    uint crossingCount;
    uint triangleCount;
    vec3 boundsMin;
    float radius;          // half the diagonal of the bounds, object space
    vec3 boundsMax;
    float scale;
    vec4 toWorld[3];       // rows of the 3×4 object-to-world matrix
    uint spare[2];
};
STATIC_SIZE(SurfaceRef, 576);
BUFFER(SurfaceBuf, SurfaceRef)

FN uint texelIndex(uint size, uint x, uint y) {
    return (((y >> 3u) * (size >> 3u) + (x >> 3u)) << 6u) + ((y & 7u) << 3u) + (x & 7u);
}
FN uint texelChart(uint bits) { return bits & 0xFFFFu; }
FN uint texelClass(uint bits) { return (bits >> 16u) & 3u; }
FN bool texelCrease(uint bits) { return ((bits >> 18u) & 1u) != 0u; }
FN uint texelClearance(uint bits) { return (bits >> 19u) & 31u; }
FN uint packTexelBits(uint chart, uint kind, uint crease, uint clearance, uint curvature8) {
    return chart | (kind << 16u) | (crease << 18u) | (clearance << 19u) | (curvature8 << 24u);
}

// Curvature is stored on a logarithmic scale: bit 7 the sign, bits 6..0 q; |curvature| = (2^(q / 8) - 1) / radius,
// in 1/m of object space; positive on bulges. The baker encodes, kernels decode.
FN float decodeCurvature(uint bits, float rcpRadius) {
    uint q = (bits >> 24u) & 0x7Fu;
    float whole = uintBitsToFloat((127u + (q >> 3u)) << 23u);
    float f = float(q & 7u) * 0.125f;
    float part = 1.0f + f * (0.6565f + f * 0.3435f);   // 2^f to 0.2 %
    float magnitude = (whole * part - 1.0f) * rcpRadius;
    return (bits >> 31u) != 0u ? -magnitude : magnitude;
}

ESPALIER_END
#endif
