// Curves that nodes of the graph make. Keys of a curve are points; through them goes a spline of cubic Bezier segments,
// whose tangent at a key is half the way from the key before to the key after (at an end, from the end).
#ifndef ESPALIER_SHARED_NODE_CURVES_H
#define ESPALIER_SHARED_NODE_CURVES_H
#include "shaders/shared/exact.h"
#include "shaders/shared/node_records.h"

ESPALIER_BEGIN

// Which points are the keys of each curve: as many different ones, at random. Key k of curve c is keys[k * row + c].
struct SubsetArgs {
    UintBuf to;
    uint row;
    uint curves, keys, points;   // keys <= points
    uint seed;
};
STATIC_SIZE(SubsetArgs, 32);

FN void pickSubset(SubsetArgs a, uint c) {
    for (uint k = 0u; k < a.keys; ++k) {
        uint point = nodeHash(a.seed, c, k) % a.points;
        // Taken already: the next one that isn't. Starting over after each step finds it whatever the order was.
        for (uint before = 0u; before < k;) {
            bool taken = a.to.v[before * a.row + c] == point;
            point = taken ? (point + 1u == a.points ? 0u : point + 1u) : point;
            before = taken ? 0u : before + 1u;
        }
        a.to.v[k * a.row + c] = point;
    }
}

// Samples of curves. The keys are points that `pick` names, or without it keys.v's own rows.
struct CurveArgs {
    NodePlanes keys;
    NodePlanes to;
    UintBuf pick;        // as SubsetArgs::to; null: element k * pickRow + c of keys is key k of curve c
    uint pickRow;
    uint row;            // of `to`
    uint curves, keyCount, samples;
    uint points;         // that there are in keys
};
STATIC_SIZE(CurveArgs, 64);

// Sample j lies in segment `segment` at t; the keys around it are before, from, to, after.
struct CurvePlace {
    uint before, from, to, after;
    float t;
};
FN CurvePlace curvePlace(CurveArgs a, uint j) {
    uint segments = a.keyCount - 1u;
    // Whole numbers decide the segment, so that samples that meet keys do so on each device.
    uint along = j * segments;
    uint last = a.samples > 1u ? a.samples - 1u : 1u;
    uint segment = along / last;
    segment = segment < segments ? segment : segments - 1u;
    CurvePlace p;
    p.from = segment;
    p.to = segment + 1u;
    p.before = segment > 0u ? segment - 1u : 0u;
    p.after = segment + 2u <= segments ? segment + 2u : segments;
    p.t = ratioExact(float(int(along - segment * last)), float(int(last)));
    return p;
}
FN uint keyOf(CurveArgs a, uint k, uint c) {
    uint at = k * a.pickRow + c;
    if (IS_GIVEN(a.pick)) at = a.pick.v[at];
    return at < a.points ? at : 0u;   // in the padding it may be anything
}
FN vec3 bezier3(vec3 p0, vec3 p1, vec3 p2, vec3 p3, float t) {
    float u = 1.0f - t;
    return p0 * (u * u * u) + p1 * (3.0f * t * u * u) + p2 * (3.0f * t * t * u) + p3 * (t * t * t);
}
FN vec3 sampleSpline(vec3 before, vec3 from, vec3 to, vec3 after, float t) {
    vec3 leaves = from + (to - before) * 0.166666667f;
    vec3 comes = to - (after - from) * 0.166666667f;
    return bezier3(from, leaves, comes, to, t);
}
FN void sampleCurve(CurveArgs a, CurvePlace p, uint j, uint c) {
    vec3 at = sampleSpline(takeVector(a.keys, keyOf(a, p.before, c)), takeVector(a.keys, keyOf(a, p.from, c)),
                           takeVector(a.keys, keyOf(a, p.to, c)), takeVector(a.keys, keyOf(a, p.after, c)), p.t);
    putVector(a.to, j * a.row + c, at);
}

// A circle in the plane z = 0 whose last sample is its first again.
struct CircleArgs {
    NodePlanes to;
    uint row, samples;
    float radius;
    float turn;    // radians, of the first sample
};
STATIC_SIZE(CircleArgs, 32);

FN void sampleCircle(CircleArgs a, uint j) {
    uint last = a.samples > 1u ? a.samples - 1u : 1u;
    float s;
    float c;
    sinCosExact(a.turn + 6.28318531f * ratioExact(float(int(j % last)), float(int(last))), s, c);
    putVector(a.to, j * a.row, vec3(a.radius * c, a.radius * s, 0.0f));
}

ESPALIER_END
#endif
