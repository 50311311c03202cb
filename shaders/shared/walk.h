// Walking over a surface (Buron 2015 §5, made intrinsic). A walk carries a unit 3D tangent: along the geodesic
// inside a chart, and by the hinge rule from chart to chart, so that it depends on the surface and not on how
// the surface lies in UV. Lengths are metres of the world; directions and positions are in object space.
//
// Use: startWalk or resumeWalk, then walkAdvance until the length is used up:
//
//     float remaining = length;
//     uint event = kWalkRetry;
//     while (walkGoesOn(event)) {
//         event = walkAdvance(surfaces, level, w, remaining, jointNormal);
//         if (walkHasSample(event)) record(w.position, jointNormal, w.walk);
//     }
//
// That loop always ends (see kWalkMaxTries). Kernels should make it one with the loop over steps, so that no
// lane waits for another's seams. A chunk that may be grown again alone must be entered by resumeWalk, which
// makes the state a function of the stored Walk.
#ifndef ESPALIER_SHARED_WALK_H
#define ESPALIER_SHARED_WALK_H
#include "shaders/shared/growth_records.h"
#include "shaders/shared/surface_lookup.h"

ESPALIER_BEGIN

// What walkAdvance met. The first leaves nothing to walk; after the next four the rest is still to be walked;
// the last two end the walk.
CONST_UINT(kWalkDone, 0u);     // the length is used up: the step's own sample goes here
CONST_UINT(kWalkSeam, 1u);     // stands on the far side of a crossing: a sample goes here
CONST_UINT(kWalkCrease, 2u);   // stands on a crease inside a chart, about to go down the far side: a sample goes here
CONST_UINT(kWalkBend, 3u);     // part of the way, because the surface turns much: a sample goes here
CONST_UINT(kWalkRetry, 4u);    // part of the way or none of it: nothing to record, call again
CONST_UINT(kWalkOpen, 5u);     // stopped at a border of the model: a sample goes here, `remaining` was not walked
CONST_UINT(kWalkLost, 6u);     // stopped: the surface has no data where the walk leads; w is where it last stood

// Events without visible progress that one step may have; then what is left of it is dropped (kWalkDone), or,
// when nothing of it was walked, the walk is lost.
CONST_UINT(kWalkMaxTries, 24u);
CONST_UINT(kWalkMaxPieces, 2048u);       // pieces that one step may be walked in; then its rest is dropped too
CONST_FLOAT(kWalkMaxTexels, 16.0f);      // longest stretch walked in one go
CONST_FLOAT(kWalkCreaseTexels, 2.0f);    // the same among creases, where a stretch should cross no more than one
CONST_FLOAT(kWalkMaxRadii, 256.0f);      // longest length that may be asked for, in radii of the surface
CONST_FLOAT(kWalkTurnCosine, 0.94f);     // a stretch over which the normal turns by more than 20 degrees is cut
CONST_FLOAT(kWalkBulgeTexels, 0.2f);     // or that bulges by more
CONST_FLOAT(kWalkBentCosine, 0.996f);    // a stretch that turned by 5 degrees ends with a sample
CONST_FLOAT(kWalkNudgeTexels, 0.004f);   // how far inside the far chart a crossing ends
CONST_FLOAT(kWalkCornerTexels, 0.01f);   // and how far from the ends of its border segment

// A walk with what the next step needs of the last one's reads.
struct WalkState {
    Walk walk;
    vec3 position;
    vec3 du, dv;         // Jacobian, metres per unit of UV
    float spread;        // spreadOf(du, dv)
    vec3 normal;         // unit, outward
    float orientation;   // of the chart
    uint level;          // stood on: the one asked for or the chart's coarsest
    float clear;         // no crossing within this distance, in UV; 0: not known
    float limit;         // longest stretch for now, object metres
    vec2 leftUv;         // where it left the chart `leftPlace` for this one, once it has
    uint leftPlace;
    vec2 slip;           // uv + slip is surely inside the chart: the last stretch's end before it was corrected
    uint flags;          // bits 7..0 tries, 8: last read was creased, 9: search crossings loosely, 10: step moved,
                         // 11: a cut for the turning is under way, 12: kWalkFlagOver, 13: kWalkFlagBeside, 31..16: pieces walked
};

CONST_UINT(kWalkFlagCrease, 1u << 8u);
CONST_UINT(kWalkFlagLoose, 1u << 9u);
CONST_UINT(kWalkFlagMoved, 1u << 10u);
CONST_UINT(kWalkFlagBend, 1u << 11u);
CONST_UINT(kWalkFlagOver, 1u << 12u);   // came over a crease, and the nearest texels may still be the near side's
CONST_UINT(kWalkFlagBeside, 1u << 13u); // last read was Patch::beside a crease

FN bool walkGoesOn(uint event) { return event >= kWalkSeam && event <= kWalkRetry; }
FN bool walkHasSample(uint event) { return event != kWalkRetry && event != kWalkLost; }

// The square of UV area per metre².
FN float spreadOf(vec3 du, vec3 dv) {
    float e = dot3(du, du);
    float f = dot3(du, dv);
    float g = dot3(dv, dv);
    return rcpExact(larger(e * g - f * f, 1e-6f * e * g));
}
// UV per metre along tangent t: the pseudoinverse of [du dv] applied to t. spread: spreadOf(du, dv).
FN vec2 spreadRate(vec3 du, vec3 dv, float spread, vec3 t) {
    float f = dot3(du, dv);
    float a = dot3(du, t);
    float b = dot3(dv, t);
    return vec2((dot3(dv, dv) * a - f * b) * spread, (dot3(du, du) * b - f * a) * spread);
}
FN vec2 tangentRate(vec3 du, vec3 dv, vec3 t) { return spreadRate(du, dv, spreadOf(du, dv), t); }

// t, tangent under unit normal n, turned with the least rotation that takes n to m; unit and tangent under m.
FN vec3 carriedTangent(vec3 t, vec3 n, vec3 m) {
    float k = divExact(dot3(m, t), larger(1.0f + dot3(n, m), 1e-3f));
    vec3 c = t - (n + m) * k;
    c = c - m * dot3(m, c);
    return unit3(c);
}

FN vec3 tangentOf(vec3 direction, vec3 n) { return unit3(direction - n * dot3(n, direction)); }

FN void standOn(INOUT(WalkState) w, Patch p, float texel) {
    w.position = p.position;
    w.du = p.du;
    w.dv = p.dv;
    w.spread = spreadOf(p.du, p.dv);
    w.normal = p.normal;
    w.clear = float(texelClearance(p.bits)) * texel;
    w.flags = (w.flags & ~(kWalkFlagCrease | kWalkFlagBeside)) | (texelCrease(p.bits) ? kWalkFlagCrease : 0u) |
              (p.beside ? kWalkFlagBeside : 0u);
}

// The state of a stored walk; a function of `walk` and the surface alone. False: no surface there.
FN bool resumeWalk(SurfaceBuf surfaces, uint level, Walk walk, OUT(WalkState) w) {
    uint instance = walk.place >> 16u;
    uint chart = walk.place & 0xFFFFu;
    w.walk = walk;
    w.walk.uv = vec2(inRange(walk.uv.x, 1.0f), inRange(walk.uv.y, 1.0f));
    uint coarsest;
    readChart(surfaces, instance, chart, w.orientation, coarsest);
    w.level = level < coarsest ? level : coarsest;
    w.limit = 1e30f;
    w.leftUv = w.walk.uv;
    w.leftPlace = walk.place;
    w.slip = vec2(0.0f);
    w.flags = 0u;
    Patch p;
    bool found = patchAt(surfaces, instance, w.level, chart, w.orientation, w.walk.uv, p);
    standOn(w, p, rcpExact(float(levelSize(surfaces, instance, w.level))));
    vec3 across = walk.direction - p.normal * dot3(p.normal, walk.direction);
    float across2 = dot3(across, across);
    bool steep = !(across2 > 1e-8f);   // along the normal, or NaN: any tangent will do
    w.walk.direction = steep ? unit3(p.du) : across * rsqrtExact(across2);
    return found;
}

// A walk from uv of a chart (place: bits 31..16 instance, 15..0 chart), along `direction` (object space, need
// not be tangent or unit). False: no surface there.
FN bool startWalk(SurfaceBuf surfaces, uint level, uint place, vec2 uv, vec3 direction, OUT(WalkState) w) {
    Walk walk;
    walk.place = place;
    walk.uv = uv;
    float size2 = dot3(direction, direction);
    walk.direction = size2 > 1e-30f ? direction * rsqrtExact(size2) : vec3(0.0f);
    walk.arc = 0.0f;
    return resumeWalk(surfaces, level, walk, w);
}

// Turns the heading by `angle` radians, counterclockwise as seen from outside.
FN void rotateHeading(INOUT(WalkState) w, float angle) {
    float s;
    float c;
    sinCosExact(angle, s, c);
    vec3 side = cross3(w.normal, w.walk.direction);
    w.walk.direction = unit3(w.walk.direction * c + side * s);
}

// The signed angle from the heading to `direction` (object space) laid into the surface, radians, [-pi, pi];
// 0 where that is along the normal.
FN float headingTo(WalkState w, vec3 direction) {
    vec3 side = cross3(w.normal, w.walk.direction);
    return atan2Exact(dot3(side, direction), dot3(w.walk.direction, direction));
}

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
    Exit best;
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

// Walks up to `remaining` metres straight on, at most to the next crossing, crease or turn of the surface, and
// takes what it walked from `remaining`. jointNormal: the outward normal for a sample put here (at joints the
// mean of both sides). `level`: the one wanted; charts that lack it are walked on their coarsest.
FN uint walkAdvance(SurfaceBuf surfaces, uint level, INOUT(WalkState) w, INOUT(float) remaining,
                    OUT(vec3) jointNormal) {
    uint instance = w.walk.place >> 16u;
    uint chart = w.walk.place & 0xFFFFu;
    float scale = surfaceScale(surfaces, instance);
    float texel = rcpExact(float(levelSize(surfaces, instance, w.level)));
    bool loose = (w.flags & kWalkFlagLoose) != 0u;
    vec3 n = w.normal;
    vec3 t = w.walk.direction;
    jointNormal = n;

    // The stretch: what remains, unless the surface turns or it is very many texels.
    remaining = inRange(remaining, kWalkMaxRadii * surfaceRadius(surfaces, instance) * scale);
    float wanted = remaining * rcpExact(scale);
    vec2 rate = spreadRate(w.du, w.dv, w.spread, t);
    float pace = length2(rate);
    float most = (w.flags & kWalkFlagCrease) != 0u ? kWalkCreaseTexels : kWalkMaxTexels;
    // What is surely within reach doesn't wait for the pace.
    float farthest = wanted;
    if (!(w.limit >= wanted && wanted * pace < 0.999f * most * texel)) {
        farthest = smaller(w.limit, most * texel * rcpExact(pace));
    }
    bool partly = farthest < wanted;
    float s = partly ? farthest : wanted;
    vec2 delta = rate * s;

    Exit leave;
    leave.fraction = 2.0f;
    leave.along = 0.0f;
    leave.crossing = 0u;
    // Where a walk goes to and fro between segments that overlap by a hair, or about a corner, it goes blindly on now and
    // then; twice, since to and fro are two tries.
    bool blind = (w.flags & 7u) >= 6u;
    if (!blind && (loose || pace * s >= w.clear)) {
        leave = findExit(surfaces, instance, w.level, chart, w.walk.uv + w.slip, delta - w.slip, w.clear, loose);
    }
    bool leaves = leave.fraction <= 1.0f;

    // Where the stretch ends, in which chart.
    vec2 to = w.walk.uv + delta;
    uint toPlace = w.walk.place;
    float toOrientation = w.orientation;
    uint toLevel = w.level;
    float toTexel = texel;
    bool open = false;
    uint edgeA = 0u;
    uint edgeB = 0u;
    vec2 e = vec2(0.0f);
    bool insideLeft = false;
    float over1 = 1.0f;   // -1: to the back of a sheet
    float joint = 0.0f;   // to another instance: crossingJoint
    if (leaves) {
        Crossing c = readCrossing(surfaces, instance, leave.crossing);
        insideLeft = (c.flags & kCrossingInsideLeft) != 0u;
        over1 = (c.flags & kCrossingTurned) != 0u ? -1.0f : 1.0f;
        // The search began where the last stretch ended before its correction; the walk itself meets the same
        // line here.
        vec2 ab = c.b - c.a;
        float k = rcpExact(cross2(delta, ab));
        float f = cross2(c.a - w.walk.uv, ab) * k;
        float lambda = cross2(c.a - w.walk.uv, delta) * k;
        if (lambda >= 0.0f && lambda <= 1.0f && absolute(f - leave.fraction) < 0.5f) {
            leave.fraction = f;
            leave.along = lambda;
        }
        open = (c.flags & 3u) == kCrossingOpen;
        edgeA = c.edge;
        edgeB = c.targetEdge;
        e = open ? c.b - c.a : c.tb - c.ta;
        if (!open) {
            uint toInstance = c.target >> 16u;
            toInstance = toInstance == 0xFFFFu ? instance : toInstance;
            joint = crossingJoint(c.flags);
            uint toChart = c.target & 0xFFFFu;
            toPlace = (toInstance << 16u) | toChart;
            uint coarsest;
            readChart(surfaces, toInstance, toChart, toOrientation, coarsest);
            toLevel = level < coarsest ? level : coarsest;
            // Seen from outside, the far chart lies on the other side of the edge; mirrored UVs swap sides.
            insideLeft = insideLeft == (toOrientation * w.orientation * over1 < 0.0f);
            toTexel = rcpExact(float(levelSize(surfaces, toInstance, toLevel)));
        }
        // Not quite to a corner, where the next segment's outside begins.
        float corner = limited(kWalkCornerTexels * toTexel * rsqrtExact(larger(dot2(e, e), 1e-30f)), 0.0f, 0.5f);
        to = (open ? c.a : c.ta) + e * limited(leave.along, corner, 1.0f - corner);
        to = nudgedInside(to, e, insideLeft, toTexel);
    }
    Patch p;
    p.position = w.position;
    p.du = w.du;
    p.dv = w.dv;
    p.normal = n;
    p.bits = 0u;
    p.beside = false;
    bool found = patchAt(surfaces, toPlace >> 16u, toLevel, toPlace & 0xFFFFu, toOrientation, to, p);

    // A gutter texel with room around it lies wholly outside: a gap between crossings let the walk through.
    found = found && (leaves || texelClass(p.bits) <= kTexelInner || texelClearance(p.bits) == 0u);

    uint tries = (w.flags & 0xFFu) + 1u;
    uint event = kWalkRetry;
    float walked = 0.0f;   // object metres
    if (!found) {
        // Outside, and no crossing was met: look again less strictly; then give up.
        event = loose || leaves ? kWalkLost : kWalkRetry;
        w.flags = w.flags | kWalkFlagLoose;
    } else if (leaves) {
        walked = larger(s * leave.fraction, 0.0f);
        // Narrow charts one after the other are no to and fro.
        tries = walked * pace > 0.05f * texel ? 0u : tries;
        vec3 t1 = carriedTangent(t, n, p.normal);
        if (!open) {
            // The hinge: the components along the edge and across it pass over unchanged.
            vec3 ea = edgeIn(edgeA, n);
            vec3 eb = edgeIn(edgeB, p.normal);
            t1 = unit3(eb * dot3(t, ea) + cross3(eb, p.normal) * (over1 * dot3(t, cross3(ea, n))));
            t1 = headedInside(p, t1, e, insideLeft);
            // n is of the near side's space; another instance's is turned against it.
            vec3 outside = p.normal * over1;
            vec3 turned = outside * (1.0f - absolute(joint)) + cross3(eb, outside) * joint;
            vec3 mean = toPlace >> 16u == instance ? n + outside : turned;
            float mean2 = dot3(mean, mean);
            jointNormal = mean2 > 1e-4f ? mean * rsqrtExact(mean2) : p.normal;
        } else {
            jointNormal = p.normal;
        }
        w.leftUv = w.walk.uv + delta * leave.fraction;
        w.leftPlace = w.walk.place;
        w.walk.place = toPlace;
        w.walk.uv = to;
        w.walk.direction = t1;
        w.orientation = toOrientation;
        w.level = toLevel;
        w.flags = w.flags & ~(kWalkFlagLoose | kWalkFlagOver);
        standOn(w, p, toTexel);
        w.clear = 0.0f;
        w.slip = vec2(0.0f);
        event = open ? kWalkOpen : kWalkSeam;
    } else {
        vec3 t1 = carriedTangent(t, n, p.normal);
        vec2 rate1 = tangentRate(p.du, p.dv, t1);
        float turn = dot3(n, p.normal);
        bool creased = (w.flags & kWalkFlagCrease) != 0u || texelCrease(p.bits);
        // Two planes meet toCrease ahead; on a smooth patch the rates of both ends count alike.
        // Of what follows, smooth stretches need nothing.
        float slope = dot3(p.normal, t);
        vec3 chord = p.position - w.position;
        bool bulges = absolute(dot3(n, chord)) * pace > kWalkBulgeTexels * texel;
        float toCrease = creased || bulges ? divExact(dot3(p.normal, chord), slope) : 0.0f;
        bool meet = creased && absolute(slope) > 1e-3f && toCrease >= 0.0f && toCrease <= s;
        vec2 correction = (rate1 - rate) * (meet ? s - toCrease : 0.5f * s);
        // Both ends far under each other's planes: the surface bulges between them.
        bulges = bulges && absolute(slope * toCrease) * pace > kWalkBulgeTexels * texel;
        bool rough = turn < kWalkTurnCosine || dot2(correction, correction) > 0.04f * dot2(delta, delta) || bulges;
        // A sharp crease. The nearest texel changes sides up to half a texel before or after the planes do.
        float close = creased ? texel * rcpExact(pace) : 0.0f;
        float height = slope * toCrease;
        float sine2 = larger(1.0f - turn * turn, 0.01f);
        bool sharp = creased && turn < kWalkTurnCosine && absolute(slope) > 1e-2f &&
                     (toCrease >= 0.0f || height * height <= close * close * sine2);
        bool over = (w.flags & kWalkFlagOver) != 0u && toCrease < 0.05f * close;
        if (sharp && (over || (toCrease > s && toCrease <= s + close))) {
            walked = s;
            w.position = w.position + t * s;
            w.walk.uv = to;
            w.slip = vec2(0.0f);
            w.clear = larger(w.clear - pace * s, 0.0f);
            event = partly ? kWalkRetry : kWalkDone;
        } else if (sharp && toCrease <= s) {
            walked = larger(toCrease, 0.0f);   // no length is ever given back, or steps might not end
            vec3 mean = n + p.normal;
            float mean2 = dot3(mean, mean);
            jointNormal = mean2 > 1e-4f ? mean * rsqrtExact(mean2) : p.normal;
            // Ahead: along the heading. Passed already: straight back to it.
            vec3 ahead = t * toCrease;
            vec3 back = (p.normal - n * turn) * divExact(height, sine2);
            vec3 shift = toCrease >= 0.0f ? ahead : back;
            vec2 shiftUv = tangentRate(w.du, w.dv, shift);
            w.position = w.position + shift;
            w.walk.uv = w.walk.uv + shiftUv;
            w.slip = vec2(0.0f);
            w.walk.direction = t1;
            w.du = p.du;
            w.dv = p.dv;
            w.spread = spreadOf(p.du, p.dv);
            w.normal = p.normal;
            w.clear = larger(w.clear - length2(shiftUv), 0.0f);
            w.flags = w.flags | kWalkFlagCrease | kWalkFlagOver;
            event = kWalkCrease;
        } else if (rough && pace * s > 0.5f * texel) {
            w.limit = 0.5f * s;
            w.flags = w.flags | kWalkFlagBend;
        } else {
            walked = s;
            w.walk.uv = to + correction;
            w.slip = vec2(0.0f) - correction;
            w.walk.direction = t1;
            standOn(w, p, texel);
            w.position = w.position + p.du * correction.x + p.dv * correction.y;
            w.clear = larger(w.clear - length2(correction), 0.0f);
            jointNormal = p.normal;
            w.limit = turn > 0.985f ? w.limit * 2.0f : w.limit;
            w.limit = smaller(w.limit, 1e30f);
            bool bend = (w.flags & kWalkFlagBend) != 0u;
            event = !partly ? kWalkDone : bend || turn < kWalkBentCosine ? kWalkBend : kWalkRetry;
            w.flags = w.flags & ~(kWalkFlagLoose | kWalkFlagBend | kWalkFlagOver);
            tries = partly ? 0u : tries;
        }
    }
    float walkedWorld = walked * scale;
    w.walk.arc = w.walk.arc + walkedWorld;
    remaining = event == kWalkDone ? 0.0f : larger(remaining - walkedWorld, 0.0f);
    w.flags = walked > 0.0f ? w.flags | kWalkFlagMoved : w.flags;
    uint pieces = (w.flags >> 16u) + 1u;
    if (walkGoesOn(event) && (tries >= kWalkMaxTries || pieces >= kWalkMaxPieces)) {
        event = (w.flags & kWalkFlagMoved) != 0u ? kWalkDone : kWalkLost;
        remaining = 0.0f;
    }
    bool ended = !walkGoesOn(event);
    w.flags = w.flags & ~(0xFFFF00FFu | (ended ? kWalkFlagMoved : 0u));
    w.flags = ended ? w.flags : w.flags | tries | (pieces << 16u);
    return event;
}

// Walks `length` metres, through everything in between. Returns kWalkDone, kWalkOpen or kWalkLost.
FN uint walkStep(SurfaceBuf surfaces, uint level, INOUT(WalkState) w, float length) {
    float remaining = length;
    vec3 jointNormal;
    uint event = kWalkRetry;
    while (walkGoesOn(event)) {
        event = walkAdvance(surfaces, level, w, remaining, jointNormal);
    }
    return event;
}

ESPALIER_END
#endif
