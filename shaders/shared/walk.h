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
#include "shaders/shared/walk_exit.h"

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

FN bool walkGoesOn(uint event) { return event >= kWalkSeam && event <= kWalkRetry; }
FN bool walkHasSample(uint event) { return event != kWalkRetry && event != kWalkLost; }

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
