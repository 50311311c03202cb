// Smooth spans between the samples of a walk (Buron 2015 §6): tangents, control points, evaluation, frames.
#ifndef ESPALIER_SHARED_BEZIER_H
#define ESPALIER_SHARED_BEZIER_H
#include "shaders/shared/exact.h"

ESPALIER_BEGIN

CONST_FLOAT(kBendCosine, 0.906f);  // a span that turns by more, 25 degrees, has a crease right beside an end

// A cubic Bézier curve over [0, 1].
struct Span {
    vec3 p0, b1, b2, p3;
};

// A right-handed frame: along × out = side.
struct Frame {
    vec3 along, out1, side;
};

// Unit vector from a to b, zero where they coincide.
FN vec3 segmentDirection(vec3 a, vec3 b) {
    vec3 d = b - a;
    float d2 = dot3(d, d);
    return d2 > 1e-30f ? d * rsqrtExact(d2) : vec3(0.0f);
}

// The tangent of a node from the sum of its adjacent segments' directions (each pointing along the growth),
// laid into the tangent plane of `normal`. fallback: a unit vector for nodes whose segments cancel out.
FN vec3 tangentFromSum(vec3 sum, vec3 normal, vec3 fallback) {
    vec3 t = sum - normal * dot3(normal, sum);
    float t2 = dot3(t, t);
    return t2 > 1e-6f ? t * rsqrtExact(t2) : fallback;
}

// The tangent of a stem's node, which ignores what branches off there. At an end, give `at` itself for the
// neighbour that is missing. heading: the walk's direction at the node.
FN vec3 stemTangent(vec3 before, vec3 at, vec3 after, vec3 normal, vec3 heading) {
    return tangentFromSum(segmentDirection(before, at) + segmentDirection(at, after), normal, heading);
}

// The span from p0 with unit tangent t0 to p3 with unit tangent t3. The handles are the paper's: a third of the
// chord laid onto each tangent; held to at least a fifteenth of the chord, so that no joint loses its tangent
// where a walk turns by 80 degrees and more, and to some hundred times what coordinates are rounded by.
FN Span smoothSpan(vec3 p0, vec3 t0, vec3 p3, vec3 t3) {
    vec3 chord = p3 - p0;
    float farthest = larger(absolute(p0.x), larger(absolute(p0.y), absolute(p0.z)));
    float least = larger(0.2f * length3(chord), 5e-5f * farthest);
    Span s = {};
    s.p0 = p0;
    s.b1 = p0 + t0 * (larger(dot3(t0, chord), least) * 0.333333333f);
    s.b2 = p3 - t3 * (larger(dot3(t3, chord), least) * 0.333333333f);
    s.p3 = p3;
    return s;
}

// The longest handle, of at most `length`, whose end rises no more than `rise` off the surface at the span's far end,
// whose normal is `far`.
FN float levelHandle(float length, vec3 tangent, vec3 far, float rise) {
    float most = divExact(rise, larger(absolute(dot3(tangent, far)), 1e-6f));
    return smaller(length, larger(most, 0.02f * length));
}

// smoothSpan with handles held level where tangents lean off the surface: on spans that turn much, and at ends on
// creases, where a tangent leans off both sides. n0, n3: unit normals at its ends. The curve itself leaves the surface
// by some four ninths of `rise`.
FN Span levelSpan(Span s, vec3 t0, vec3 n0, bool crease0, vec3 t3, vec3 n3, bool crease3, float rise) {
    bool bends = dot3(n0, n3) < kBendCosine;
    Span o = s;
    if (bends || crease0) o.b1 = s.p0 + t0 * levelHandle(length3(s.b1 - s.p0), t0, n3, rise);
    if (bends || crease3) o.b2 = s.p3 - t3 * levelHandle(length3(s.p3 - s.b2), t3, n0, rise);
    return o;
}

// The straight span, for the two lesser smoothnesses.
FN Span straightSpan(vec3 p0, vec3 p3) {
    vec3 third = (p3 - p0) * 0.333333333f;
    Span s = {};
    s.p0 = p0;
    s.b1 = p0 + third;
    s.b2 = p3 - third;
    s.p3 = p3;
    return s;
}

FN vec3 spanPoint(Span s, float u) {
    float v = 1.0f - u;
    return s.p0 * (v * v * v) + s.b1 * (3.0f * v * v * u) + s.b2 * (3.0f * v * u * u) + s.p3 * (u * u * u);
}

// dB/du; zero only where control points coincide.
FN vec3 spanVelocity(Span s, float u) {
    float v = 1.0f - u;
    return ((s.b1 - s.p0) * (v * v) + (s.b2 - s.b1) * (2.0f * v * u) + (s.p3 - s.b2) * (u * u)) * 3.0f;
}

// Chord and control polygon bound the length from both sides; their mean is within 1 % for spans that turn by
// less than 60 degrees.
FN float spanLength(Span s) {
    float polygon = length3(s.b1 - s.p0) + length3(s.b2 - s.b1) + length3(s.p3 - s.b2);
    return 0.5f * (polygon + length3(s.p3 - s.p0));
}

// The frame at u between surface normals n0 and n3: `out1` is their blend made perpendicular to the curve, so it
// turns no more than the surface does and agrees between spans that share a joint.
FN Frame spanFrame(Span s, float u, vec3 n0, vec3 n3) {
    vec3 velocity = spanVelocity(s, u);
    float v2 = dot3(velocity, velocity);
    Frame f = {};
    f.along = v2 > 1e-30f ? velocity * rsqrtExact(v2) : unit3(s.p3 - s.p0);
    vec3 n = n0 * (1.0f - u) + n3 * u;
    n = n - f.along * dot3(f.along, n);
    float n2 = dot3(n, n);
    if (!(n2 > 1e-6f)) {
        // The blend lies along the curve or vanishes: take the normal that is less along it.
        vec3 m = absolute(dot3(n0, f.along)) < absolute(dot3(n3, f.along)) ? n0 : n3;
        n = m - f.along * dot3(f.along, m);
        n2 = dot3(n, n);
    }
    if (!(n2 > 1e-6f)) {
        vec3 axis = absolute(f.along.x) < 0.6f ? vec3(1.0f, 0.0f, 0.0f) : vec3(0.0f, 1.0f, 0.0f);
        n = axis - f.along * dot3(f.along, axis);
        n2 = dot3(n, n);
    }
    f.out1 = n * rsqrtExact(n2);
    f.side = cross3(f.along, f.out1);
    return f;
}

ESPALIER_END
#endif
