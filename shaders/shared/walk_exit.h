// Where a walk leaves its chart, and how it stands beyond a border (Buron 2015 §5.2; walk.h walks).
#ifndef ESPALIER_SHARED_WALK_EXIT_H
#define ESPALIER_SHARED_WALK_EXIT_H
#include "shaders/shared/walk_state.h"

ESPALIER_BEGIN

CONST_FLOAT(kWalkNudgeTexels, 0.004f);   // how far inside the far chart a crossing ends
CONST_FLOAT(kWalkCornerTexels, 0.01f);   // and how far from the ends of its border segment

// Where a walk leaves its chart.
struct Exit {
    float fraction;      // of the stretch, [0, 1]; above 1: it stays
    float along;         // on the crossing's segment, [0, 1]
    uint crossing;       // index into SurfaceRef::crossings
};

// The first crossing that the stretch uv -> uv + delta meets going out of its chart, by the texels that it
// passes. `clear`: nothing within this distance of uv. Loosely: looks two texels back and forgives gaps.
FN Exit findExit(SurfaceBuf surfaces, uint instance, uint level, uint chart, vec2 uv, vec2 delta, float clear,
                 bool loose) {
    uint size = levelSize(surfaces, instance, level);
    float fsize = float(size);
    float texel = rcpExact(fsize);
    float gap = loose ? 1.0f * texel : 0.002f * texel;      // along a segment, beyond its ends
    // Outside the border already; less than the nudge, or both sides of a slit would catch.
    float behind = loose ? 2.0f * texel : 0.0035f * texel;
    Exit best = {};
    best.fraction = 2.0f;
    best.along = 0.0f;
    best.crossing = 0u;

    float reach = larger(length2(delta), 1e-12f);
    float from = loose ? divExact(-2.0f * texel, reach) : divExact(larger(clear - 0.5f * texel, 0.0f), reach);
    vec2 g = (uv + delta * from) * fsize;
    vec2 d = delta * fsize;
    int x = int(floorExact(limited(g.x, -1.0f, fsize)));
    int y = int(floorExact(limited(g.y, -1.0f, fsize)));
    int stepX = d.x < 0.0f ? -1 : 1;
    int stepY = d.y < 0.0f ? -1 : 1;
    float perX = rcpExact(larger(absolute(d.x), 1e-9f));
    float perY = rcpExact(larger(absolute(d.y), 1e-9f));
    float nextX = from + (d.x < 0.0f ? g.x - float(x) : float(x) + 1.0f - g.x) * perX;
    float nextY = from + (d.y < 0.0f ? g.y - float(y) : float(y) + 1.0f - g.y) * perY;
    float enter = from;

    // One flat loop over texels and their crossings: a trip either enters the next texel or tests one crossing.
    uint left = 0u;
    uint ref = 0u;
    bool live = true;
    for (uint i = 0u; i < 192u && live; ++i) {
        if (left == 0u) {
            live = enter <= smaller(best.fraction, 1.0f);
            bool inside = x >= 0 && y >= 0 && x < int(size) && y < int(size);
            if (live && inside) {
                uint head = readHead(surfaces, instance, level, texelRow(size, uint(y)) + texelColumn(uint(x)));
                left = head & 0xFFu;
                ref = head >> 8u;
            }
            enter = smaller(nextX, nextY);
            if (nextX < nextY) {
                nextX = nextX + perX;
                x = x + stepX;
            } else {
                nextY = nextY + perY;
                y = y + stepY;
            }
        }
        if (left > 0u) {
            uint index = readRef(surfaces, instance, level, ref);
            Crossing c = readCrossing(surfaces, instance, index);
            vec2 a = c.a;
            vec2 e = c.b - a;
            uint flags = c.flags;
            vec2 r = a - uv;
            float out1 = cross2(delta, e);                 // positive: towards the right of a -> b
            float side = (flags & 4u) != 0u ? out1 : -out1;
            float depth = cross2(r, e);
            float k = rcpExact(out1);
            float e2 = dot2(e, e);
            float f = depth * k;
            // Already outside: the nearest point of the segment instead of the intersection, and no gap, or
            // the sides of a notch would catch walks that pass its tip.
            bool outside = f < 0.0f;
            float lambda = outside ? -dot2(r, e) * rcpExact(e2) : cross2(r, delta) * k;
            float over = larger(larger(-lambda, lambda - 1.0f), 0.0f);
            float most = outside && !loose ? 0.0f : gap;
            bool near1 = !outside || depth * depth <= behind * behind * e2;
            f = larger(f, 0.0f);
            if ((flags >> 16u) == chart && side > 0.0f && e2 > 0.0f && near1 && f <= 1.0f &&
                over * over * e2 <= most * most && f < best.fraction) {
                best.fraction = f;
                best.along = limited(lambda, 0.0f, 1.0f);
                best.crossing = index;
            }
            ref = ref + 1u;
            left = left - 1u;
        }
    }
    return best;
}

// Unit direction along a crossing laid into the tangent plane of n.
FN vec3 edgeIn(uint packedEdge, vec3 n) { return tangentOf(unpackOct(packedEdge), n); }

// UV just inside a chart from `at` on its border segment e. insideLeft: the chart lies to the left of e.
FN vec2 nudgedInside(vec2 at, vec2 e, bool insideLeft, float texel) {
    float k = kWalkNudgeTexels * texel * rsqrtExact(larger(dot2(e, e), 1e-30f));
    k = insideLeft ? k : -k;
    return vec2(at.x - e.y * k, at.y + e.x * k);
}

// Tangent t of patch p made to lead off the border e into the chart, where rounding or the patch's own error makes
// a grazing walk lead out again: then along the border and a hundredth inward.
FN vec3 headedInside(Patch p, vec3 t, vec2 e, bool insideLeft) {
    vec2 rate = tangentRate(p.du, p.dv, t);
    float inward = insideLeft ? cross2(e, rate) : -cross2(e, rate);
    float k = rsqrtExact(larger(dot2(e, e), 1e-30f));
    vec2 along = e * (k * sign1(dot2(e, rate)));
    vec2 in1 = insideLeft ? vec2(-e.y, e.x) * (0.01f * k) : vec2(e.y, -e.x) * (0.01f * k);
    vec2 grazing = along + in1;
    bool graze = inward < 1e-3f * length2(rate) * length2(e);
    return graze ? unit3(p.du * grazing.x + p.dv * grazing.y) : t;
}

ESPALIER_END
#endif
