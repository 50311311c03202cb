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
#include "shaders/shared/walk_stretch.h"

ESPALIER_BEGIN

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

    remaining = inRange(remaining, kWalkMaxRadii * surfaceRadius(surfaces, instance) * scale);
    Stretch s = stretchOf(w, remaining * rcpExact(scale), texel);
    vec2 delta = s.delta;

    Exit leave;
    leave.fraction = 2.0f;
    leave.along = 0.0f;
    leave.crossing = 0u;
    if (s.searches) {
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
    bool found = patchAt(surfaces, toPlace >> 16u, toLevel, toPlace & 0xFFFFu, toOrientation, to, p);

    found = found && (leaves || liesInside(p));

    uint tries = (w.flags & 0xFFu) + 1u;
    uint event = kWalkRetry;
    float walked = 0.0f;   // object metres
    if (!found) {
        // Outside, and no crossing was met: look again less strictly; then give up.
        event = loose || leaves ? kWalkLost : kWalkRetry;
        w.flags = w.flags | kWalkFlagLoose;
    } else if (leaves) {
        walked = larger(s.metres * leave.fraction, 0.0f);
        // Narrow charts one after the other are no to and fro.
        tries = walked * s.pace > 0.05f * texel ? 0u : tries;
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
        Landing l = landingOf(w, s, p, texel);
        if (l.passed) {
            walked = s.metres;
            w.position = w.position + t * s.metres;
            w.walk.uv = to;
            w.slip = vec2(0.0f);
            w.clear = larger(w.clear - s.pace * s.metres, 0.0f);
            event = s.partly ? kWalkRetry : kWalkDone;
        } else if (l.crosses) {
            walked = larger(l.toCrease, 0.0f);   // no length is ever given back, or steps might not end
            vec3 mean = n + p.normal;
            float mean2 = dot3(mean, mean);
            jointNormal = mean2 > 1e-4f ? mean * rsqrtExact(mean2) : p.normal;
            // Ahead: along the heading. Passed already: straight back to it.
            vec3 ahead = t * l.toCrease;
            vec3 back = (p.normal - n * l.turn) * divExact(l.height, l.sine2);
            vec3 shift = l.toCrease >= 0.0f ? ahead : back;
            vec2 shiftUv = tangentRate(w.du, w.dv, shift);
            w.position = w.position + shift;
            w.walk.uv = w.walk.uv + shiftUv;
            w.slip = vec2(0.0f);
            w.walk.direction = l.direction;
            w.du = p.du;
            w.dv = p.dv;
            w.spread = spreadOf(p.du, p.dv);
            w.normal = p.normal;
            w.clear = larger(w.clear - length2(shiftUv), 0.0f);
            w.flags = w.flags | kWalkFlagCrease | kWalkFlagOver;
            tries = walked * s.pace > 0.05f * texel ? 0u : tries;   // nor are creases
            event = kWalkCrease;
        } else if (l.turns) {
            w.limit = 0.5f * s.metres;
            w.flags = w.flags | kWalkFlagBend;
        } else {
            walked = s.metres;
            event = landOn(w, s, l, p, to, texel);
            jointNormal = p.normal;
            tries = s.partly ? 0u : tries;
        }
    }
    return endStretch(w, remaining, event, walked, tries, scale);
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
