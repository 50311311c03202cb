// What a dab does to a texel, and the records of painting. Layers decide growth, so this is exact arithmetic too.
//
// A layer's texels lie in texelIndex order, so that block b, 8×8 texels, is the floats [64 b, 64 b + 64). Blocks are
// what dabs are culled by and what strokes keep for undoing.
#ifndef ESPALIER_PAINT_BRUSH_H
#define ESPALIER_PAINT_BRUSH_H
#include "shaders/shared/exact.h"
#include "shaders/shared/surface_records.h"

ESPALIER_BEGIN

CONST_UINT(kBlockTexels, 64u);
CONST_UINT(kDabsAtOnce, 32u);   // of one dispatch, in order
CONST_FLOAT(kSmoothReach, 0.12f);   // of a brush's radius, from a texel to what smoothing takes the mean of

// BrushRecord::flags
CONST_UINT(kBrushSlope, 1u);
CONST_UINT(kBrushHeight, 2u);
CONST_UINT(kBrushFront, 4u);    // only texels that face the way the dab does

// Where on a surface a brush paints. A limit passes fully within [low, high] and fades to nothing over 1 / per... beyond it.
struct BrushLimits {
    float slopeLow, slopeHigh, perSlope;      // radians from the upward
    float heightLow, heightHigh, perHeight;   // metres
};
STATIC_SIZE(BrushLimits, 24);

struct BrushRecord {
    float perRadius;           // 1 / radius
    float hardness;            // share of the radius that is painted fully
    float perSoft;             // 1 / (1 - hardness), large where that is nothing
    float target;              // what texels are painted towards
    float strength;
    BrushLimits limits;
    uint flags;
    uint dabs;                 // of this dispatch
    uint gutters;              // smoothing: 0 inner texels, 1 the gutters
    uint fine;                 // smoothing: a whole texel is too coarse a place for so short a reach
    uint spare;
};
STATIC_SIZE(BrushRecord, 64);

// World space, 32 bytes.
struct DabRecord {
    vec3 position;
    float pressure;
    vec3 normal;
    float spare;
};
STATIC_SIZE(DabRecord, 32);

// A layer over a placed surface as the kernels get it, push constants of 128 bytes.
struct PaintEnv {
    TexelBuf texels;           // of the surface's finest level, as baked
    TexelTiles texelTiles;     // where others touch it: the placement's own; else none
    TexelAuxBuf aux;
    FloatBuf layer;
    UintBuf blocks;            // those to be painted
    vec4 toWorld[3];           // rows
    float perScale;            // 1 / the placement's scale
    uint count;                // of blocks
    uint instance;
    uint size;                 // texels a side
    FloatBuf result;           // smoothing writes here first, [64 * i]: block blocks[i]
    UintBuf slots;             // [i]: which of the stroke's blocks block blocks[i] is
    UintBuf places;            // see smooth_records.h
};
STATIC_SIZE(PaintEnv, 128);

// 1 within [low, high], 0 a fade beyond; smooth between.
FN float limitWeight(float v, float low, float high, float per) {
    float t = limited(1.0f - larger(low - v, v - high) * per, 0.0f, 1.0f);
    return t * t * (3.0f - 2.0f * t);
}

FN float slopeWeight(BrushLimits l, vec3 n) {
    return limitWeight(atan2Exact(sqrtExact(n.x * n.x + n.z * n.z), n.y), l.slopeLow, l.slopeHigh, l.perSlope);
}
FN float heightWeight(BrushLimits l, vec3 p) { return limitWeight(p.y, l.heightLow, l.heightHigh, l.perHeight); }

// The share of a texel's way to the target that one dab makes it go, 0 to 1. n: unit; both in world space.
FN float dabWeight(BrushRecord b, DabRecord d, vec3 p, vec3 n) {
    vec3 offset = p - d.position;
    float x = sqrtExact(dot3(offset, offset)) * b.perRadius;
    float t = limited((x - b.hardness) * b.perSoft, 0.0f, 1.0f);
    float w = x < 1.0f ? 1.0f - t * t * (3.0f - 2.0f * t) : 0.0f;
    if ((b.flags & kBrushSlope) != 0u) w = w * slopeWeight(b.limits, n);
    if ((b.flags & kBrushHeight) != 0u) w = w * heightWeight(b.limits, p);
    // Over the last degrees to a right angle the weight falls to nothing, so that the edge isn't ragged.
    if ((b.flags & kBrushFront) != 0u) w = w * limited(dot3(n, d.normal) * 8.0f, 0.0f, 1.0f);
    return limited(w * b.strength * d.pressure, 0.0f, 1.0f);
}

// A value some way towards another; all the way is exactly there, none of it exactly here.
FN float towards(float value, float target, float share) {
    return share < 1.0f ? value + (target - value) * share : target;
}

ESPALIER_END
#endif
