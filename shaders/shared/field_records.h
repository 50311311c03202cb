// A tangent field as kernels read it: one texel for each of a surface's finest level (Li 2011 §4.2).
#ifndef ESPALIER_SHARED_FIELD_RECORDS_H
#define ESPALIER_SHARED_FIELD_RECORDS_H
#include "shaders/shared/rule_map.h"
#include "shaders/shared/surface_lookup.h"

ESPALIER_BEGIN

// direction: octahedral, 2 × 16 bit snorm, one of the field's N directions, in object space; any where there is no
// surface. mean: of the eigenvalues; deviator: half of their difference, of a vector field its length. Halves would be
// too coarse: a length changes by some 0.1 % from a texel to the next.
struct FieldTexel {
    uint direction;
    float mean, deviator;
};
STATIC_SIZE(FieldTexel, 12);
BUFFER(FieldTexelBuf, FieldTexel)

// texels: in texelIndex order, of the surface's finest level, of `size` texels a side. symmetry: N; 0: there is no field.
struct FieldRef {
    FieldTexelBuf texels;
    uint size;
    uint symmetry;
};
STATIC_SIZE(FieldRef, 16);
BUFFER(FieldBuf, FieldRef)   // [instance * kMaxFields + field]

// The angle in (-pi / n, pi / n] that leads to the nearest of n directions.
FN float nearestTurn(float angle, float n) {
    float turns = angle * n * 0.159154943f;
    return (turns - floorExact(turns + 0.5f)) * divExact(6.28318531f, n);
}

// The angle from one tangent direction to another, counterclockwise as seen from outside.
FN float angleBetween(vec3 normal, vec3 from, vec3 to) {
    return atan2Exact(dot3(cross3(normal, from), to), dot3(from, to));
}

// What a field says at a place.
struct FieldSample {
    float angle;         // from the direction asked about to the nearest of the field's
    float sure;          // 1 where the directions around agree, 0 at a singularity and where there is no surface
    float mean, deviator;
};

// Bilinear among the texels of the chart: their directions as N-th powers, each laid into the plane of `normal`. along:
// a tangent direction there, object space.
FN FieldSample fieldAt(SurfaceBuf surfaces, FieldRef field, uint instance, uint chart, vec2 uv, vec3 normal, vec3 along) {
    FieldSample f = {};
    f.angle = 0.0f;
    f.sure = 0.0f;
    f.mean = 0.0f;
    f.deviator = 0.0f;
    float n = float(field.symmetry);
    float sum = 0.0f;
    vec2 power = vec2(0.0f);
    Cell c = cellAt(float(field.size), uv);
    float fx = limited(c.fx, 0.0f, 1.0f);
    float fy = limited(c.fy, 0.0f, 1.0f);
    for (uint i = 0u; i < 4u; ++i) {
        uint at = i == 0u ? c.at00 : i == 1u ? c.at10 : i == 2u ? c.at01 : c.at11;
        bool owned = texelOwned(readTexel(surfaces, instance, 0u, at).bits, chart);
        float share = ((i & 1u) != 0u ? fx : 1.0f - fx) * ((i & 2u) != 0u ? fy : 1.0f - fy);
        share = owned ? larger(share, 1e-6f) : 0.0f;
        FieldTexel t = field.texels.v[at];
        float s = 0.0f;
        float k = 0.0f;
        sinCosExact(angleBetween(normal, along, unpackOct(t.direction)) * n, s, k);
        power = power + vec2(k, s) * share;
        f.mean = f.mean + t.mean * share;
        f.deviator = f.deviator + t.deviator * share;
        sum = sum + share;
    }
    float k = sum > 0.0f ? rcpExact(sum) : 0.0f;
    f.angle = divExact(atan2Exact(power.y, power.x), n);
    f.sure = length2(power) * k;
    f.mean = f.mean * k;
    f.deviator = f.deviator * k;
    return f;
}

ESPALIER_END
#endif
