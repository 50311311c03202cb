// A ring of bark at full detail: twelve vertices around a span, on a circle across the surface's normal (Buron 2015 §6).
// One text for the kernel that writes triangles and for native code, the same to the bit.
#ifndef ESPALIER_EMIT_BARK_RING_H
#define ESPALIER_EMIT_BARK_RING_H
#include "shaders/emit/span_load.h"

ESPALIER_BEGIN

CONST_FLOAT(kBarkCosine, 0.8660254f);   // of 30 degrees

struct BarkRing {
    vec3 center, side, up;   // side and up: unit, perpendicular to each other and to the curve
    float radius;
};

// At a branch's end, which is drawn in to a half sphere.
FN bool roundedTip(SpanInstance o) { return (o.bits & 64u) != 0u; }
FN float tipRadius(SpanInstance o, uint ring) {
    float u = float(ring) * (1.0f / float(kBarkRings - 1u));
    return larger(barkRadius(o.radius0, o.radius1, o.metres, true, u), 1e-7f);
}

// With the radius that it has but for a rounded tip.
FN BarkRing barkRing(SpanInstance o, vec3 normal0, vec3 normal1, uint ring) {
    float u = float(ring) * (1.0f / float(kBarkRings - 1u));
    float v = 1.0f - u;
    vec3 along = (o.b1 - o.p0) * (v * v) + (o.b2 - o.b1) * (2.0f * v * u) + (o.p3 - o.b2) * (u * u);
    BarkRing r;
    r.center = o.p0 * (v * v * v) + o.b1 * (3.0f * v * v * u) + o.b2 * (3.0f * v * u * u) + o.p3 * (u * u * u);
    r.side = cross3(normal0 * v + normal1 * u, along);
    r.side = r.side * rsqrtExact(larger(dot3(r.side, r.side), 1e-30f));
    r.up = cross3(along, r.side);
    r.up = r.up * rsqrtExact(larger(dot3(r.up, r.up), 1e-30f));
    r.radius = o.radius0 * v + o.radius1 * u;
    r.center = r.center + r.up * (kBarkRise * r.radius);
    return r;
}

// Snorm bits of both numbers, rounded; the bias that makes them positive falls away.
FN uint snormBits(float x, float y) {
    return (uint(int(x * 32767.0f + 65536.5f)) & 0xFFFFu) | (uint(int(y * 32767.0f + 65536.5f)) << 16u);
}

// Two opposite vertices of a ring, center +- n radius, and the octahedral bits of n and -n. Exactly one of these lies on
// the folded half of the octahedron, and the fold is odd: one projection and one fold serve both.
struct BarkPair {
    vec3 arm;
    uint ahead, behind;
};
FN BarkPair barkPair(BarkRing r, float across, float upward) {
    vec3 n = r.side * across + r.up * upward;
    float ax = absolute(n.x);
    float ay = absolute(n.y);
    float k = rcpExact(ax + ay + absolute(n.z));
    float x = n.x * k;
    float y = n.y * k;
    float fx = 1.0f - ay * k;
    float fy = 1.0f - ax * k;
    fx = x < 0.0f ? -fx : fx;
    fy = y < 0.0f ? -fy : fy;
    bool below = n.z < 0.0f;
    BarkPair p;
    p.arm = n * r.radius;
    p.ahead = snormBits(below ? fx : x, below ? fy : y);
    p.behind = snormBits(below ? -x : -fx, below ? -y : -fy);
    return p;
}

ESPALIER_END
#endif
