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

// Where a stretch ends: in its chart, or beyond the crossing that it meets.
struct Reach {
    vec2 to;
    uint place;          // as Walk::place
    uint level;
    float orientation;   // of that chart
    float texel;         // of that level, in UV
    bool leaves;         // it meets one: nothing of what follows counts otherwise
    float fraction;      // of the stretch before it
    bool open;
    bool insideLeft;     // the chart lies to the left of e,
    vec2 e;              // the border in its UV,
    uint edgeA, edgeB;   // and in space on both sides, packed
    float outside1;      // -1: to the back of a sheet
    float across1;       // -1: left there is right here
    float joint;         // to another instance: crossingJoint
};

FN Reach reachInside(WalkState w, Stretch s, float texel) {
    Reach r = {};
    r.to = w.walk.uv + s.delta;
    r.place = w.walk.place;
    r.level = w.level;
    r.orientation = w.orientation;
    r.texel = texel;
    r.leaves = false;
    r.fraction = 2.0f;
    r.open = false;
    r.insideLeft = false;
    r.e = vec2(0.0f);
    r.edgeA = 0u;
    r.edgeB = 0u;
    r.outside1 = 1.0f;
    r.across1 = 1.0f;
    r.joint = 0.0f;
    return r;
}

// The same beyond the crossing at `leave`. level: the one wanted.
FN void reachBeyond(SurfaceBuf surfaces, uint level, WalkState w, vec2 delta, Exit leave, INOUT(Reach) r) {
    uint instance = w.walk.place >> 16u;
    Crossing c = readCrossing(surfaces, instance, leave.crossing);
    r.leaves = true;
    r.insideLeft = (c.flags & kCrossingInsideLeft) != 0u;
    r.outside1 = (c.flags & kCrossingTurned) != 0u ? -1.0f : 1.0f;
    r.across1 = (c.flags & kCrossingMirrored) != 0u ? -r.outside1 : r.outside1;
    // The search began where the last stretch ended before its correction; the walk itself meets the same
    // line here.
    vec2 ab = c.b - c.a;
    float k = rcpExact(cross2(delta, ab));
    float f = cross2(c.a - w.walk.uv, ab) * k;
    float lambda = cross2(c.a - w.walk.uv, delta) * k;
    bool meets = lambda >= 0.0f && lambda <= 1.0f && absolute(f - leave.fraction) < 0.5f;
    r.fraction = meets ? f : leave.fraction;
    float along = meets ? lambda : leave.along;
    r.open = (c.flags & 3u) == kCrossingOpen;
    r.edgeA = c.edge;
    r.edgeB = c.targetEdge;
    r.e = r.open ? ab : c.tb - c.ta;
    if (!r.open) {
        uint toInstance = c.target >> 16u;
        toInstance = toInstance == 0xFFFFu ? instance : toInstance;
        r.joint = crossingJoint(c.flags);
        uint toChart = c.target & 0xFFFFu;
        r.place = (toInstance << 16u) | toChart;
        uint coarsest = 0u;
        readChart(surfaces, toInstance, toChart, r.orientation, coarsest);
        r.level = level < coarsest ? level : coarsest;
        // Seen from outside, the far chart lies on the other side of the edge; mirrored UVs swap sides.
        r.insideLeft = r.insideLeft == (r.orientation * w.orientation * r.across1 < 0.0f);
        r.texel = rcpExact(float(levelSize(surfaces, toInstance, r.level)));
    }
    // Not quite to a corner, where the next segment's outside begins.
    float corner = limited(kWalkCornerTexels * r.texel * rsqrtExact(larger(dot2(r.e, r.e), 1e-30f)), 0.0f, 0.5f);
    r.to = (r.open ? c.a : c.ta) + r.e * limited(along, corner, 1.0f - corner);
    r.to = nudgedInside(r.to, r.e, r.insideLeft, r.texel);
}

// Takes the walk over the crossing onto the far side's patch. jointNormal: the mean of both sides' outsides, or the far
// one's.
FN void crossOver(INOUT(WalkState) w, vec2 delta, Reach r, Patch p, OUT(vec3) jointNormal) {
    vec3 n = w.normal;
    vec3 t = w.walk.direction;
    vec3 t1 = carriedTangent(t, n, p.normal);
    jointNormal = p.normal;
    if (!r.open) {
        // The hinge: the components along the edge and across it pass over unchanged.
        vec3 ea = edgeIn(r.edgeA, n);
        vec3 eb = edgeIn(r.edgeB, p.normal);
        t1 = unit3(eb * dot3(t, ea) + cross3(eb, p.normal) * (r.across1 * dot3(t, cross3(ea, n))));
        t1 = headedInside(p, t1, r.e, r.insideLeft);
        // n is of the near side's space; another instance's is turned against it.
        vec3 outside = p.normal * r.outside1;
        vec3 turned = outside * (1.0f - absolute(r.joint)) + cross3(eb, outside) * r.joint;
        vec3 mean = r.place >> 16u == w.walk.place >> 16u ? n + outside : turned;
        float mean2 = dot3(mean, mean);
        jointNormal = mean2 > 1e-4f ? mean * rsqrtExact(mean2) : p.normal;
    }
    w.leftUv = w.walk.uv + delta * r.fraction;
    w.leftPlace = w.walk.place;
    w.walk.place = r.place;
    w.walk.uv = r.to;
    w.walk.direction = t1;
    w.orientation = r.orientation;
    w.level = r.level;
    w.flags = w.flags & ~(kWalkFlagLoose | kWalkFlagOver);
    standOn(w, p, r.texel);
    w.clear = 0.0f;
    w.slip = vec2(0.0f);
}

// Takes the walk to the sharp crease that landing has found on its way, and turns it down the far side.
FN void crossCrease(INOUT(WalkState) w, Landing l, Patch p, OUT(vec3) jointNormal) {
    vec3 n = w.normal;
    vec3 mean = n + p.normal;
    float mean2 = dot3(mean, mean);
    jointNormal = mean2 > 1e-4f ? mean * rsqrtExact(mean2) : p.normal;
    // Ahead: along the heading. Passed already: straight back to it.
    vec3 ahead = w.walk.direction * l.toCrease;
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
}

// Takes the walk as far as its stretch serves: to its reach, a crease, or nowhere. p: the patch at its reach, if
// `found`. texel: of the level that w stands on. jointNormal: see walkAdvance.
FN uint takeReach(INOUT(WalkState) w, INOUT(float) remaining, Stretch s, Reach r, Patch p, bool found, float texel,
                  float scale, OUT(vec3) jointNormal) {
    jointNormal = w.normal;
    found = found && (r.leaves || liesInside(p));
    uint tries = (w.flags & 0xFFu) + 1u;
    uint event = kWalkRetry;
    float walked = 0.0f;   // object metres
    if (!found) {
        // Outside, and no crossing was met: look again less strictly; then give up.
        event = (w.flags & kWalkFlagLoose) != 0u || r.leaves ? kWalkLost : kWalkRetry;
        w.flags = w.flags | kWalkFlagLoose;
    } else if (r.leaves) {
        walked = larger(s.metres * r.fraction, 0.0f);
        // Narrow charts one after the other are no to and fro.
        tries = walked * s.pace > 0.05f * texel ? 0u : tries;
        crossOver(w, s.delta, r, p, jointNormal);
        event = r.open ? kWalkOpen : kWalkSeam;
    } else {
        Landing l = landingOf(w, s, p, texel);
        if (l.passed) {
            walked = s.metres;
            w.position = w.position + w.walk.direction * s.metres;
            w.walk.uv = r.to;
            w.slip = vec2(0.0f);
            w.clear = larger(w.clear - s.pace * s.metres, 0.0f);
            event = s.partly ? kWalkRetry : kWalkDone;
        } else if (l.crosses) {
            walked = larger(l.toCrease, 0.0f);   // no length is ever given back, or steps might not end
            crossCrease(w, l, p, jointNormal);
            tries = walked * s.pace > 0.05f * texel ? 0u : tries;   // nor are creases
            event = kWalkCrease;
        } else if (l.turns) {
            w.limit = 0.5f * s.metres;
            w.flags = w.flags | kWalkFlagBend;
        } else {
            walked = s.metres;
            event = landOn(w, s, l, p, r.to, texel);
            jointNormal = p.normal;
            tries = s.partly ? 0u : tries;
        }
    }
    return endStretch(w, remaining, event, walked, tries, scale);
}

// Walks up to `remaining` metres straight on, at most to the next crossing, crease or turn of the surface, and
// takes what it walked from `remaining`. jointNormal: the outward normal for a sample put here (at joints the
// mean of both sides). `level`: the one wanted; charts that lack it are walked on their coarsest.
FN uint walkAdvance(SurfaceBuf surfaces, uint level, INOUT(WalkState) w, INOUT(float) remaining,
                    OUT(vec3) jointNormal) {
    uint instance = w.walk.place >> 16u;
    float scale = surfaceScale(surfaces, instance);
    float texel = rcpExact(float(levelSize(surfaces, instance, w.level)));
    remaining = inRange(remaining, kWalkMaxRadii * surfaceRadius(surfaces, instance) * scale);
    Stretch s = stretchOf(w, remaining * rcpExact(scale), texel);
    Reach r = reachInside(w, s, texel);
    if (s.searches) {
        Exit leave = findExit(surfaces, instance, w.level, w.walk.place & 0xFFFFu, w.walk.uv + w.slip, s.delta - w.slip,
                              w.clear, (w.flags & kWalkFlagLoose) != 0u);
        if (leave.fraction <= 1.0f) reachBeyond(surfaces, level, w, s.delta, leave, r);
    }
    Patch p = {};
    bool found = patchAt(surfaces, r.place >> 16u, r.level, r.place & 0xFFFFu, r.orientation, r.to, p);
    return takeReach(w, remaining, s, r, p, found, texel, scale, jointNormal);
}

// Walks `length` metres, through everything in between. Returns kWalkDone, kWalkOpen or kWalkLost.
FN uint walkStep(SurfaceBuf surfaces, uint level, INOUT(WalkState) w, float length) {
    float remaining = length;
    vec3 jointNormal = vec3(0.0f);
    uint event = kWalkRetry;
    while (walkGoesOn(event)) {
        event = walkAdvance(surfaces, level, w, remaining, jointNormal);
    }
    return event;
}

ESPALIER_END
#endif
