// A scope on its way: commands, and the walk along a field (Li 2011 §4.3).
#ifndef ESPALIER_SHARED_PATTERN_SCOPE_H
#define ESPALIER_SHARED_PATTERN_SCOPE_H
#include "shaders/shared/expand_scope.h"
#include "shaders/shared/pattern_records.h"

ESPALIER_BEGIN

CONST_FLOAT(kTraceTexels, 4.0f);      // longest step along a field
CONST_FLOAT(kTraceTurn, 0.1f);        // radians that a field may turn over one
CONST_FLOAT(kTraceSure, 0.25f);       // FieldSample::sure below which the way goes straight on
CONST_UINT(kTraceSteps, 8192u);       // of one T

// A scope with the walk's state at hand.
struct Turtle {
    WalkState w;
    float lift;
    vec4 turn;
    vec3 size;
};

FN vec3 turned(vec4 q, vec3 v) {
    vec3 a = vec3(q.x, q.y, q.z);
    vec3 c = cross3(a, v) * 2.0f;
    return v + c * q.w + cross3(a, c);
}
// q, then a turn about axis i of its own.
FN vec4 turnedAbout(vec4 q, uint axis, float angle) {
    float s = 0.0f;
    float c = 0.0f;
    sinCosExact(limited(angle, -8000.0f, 8000.0f) * 0.5f, s, c);
    vec3 a = vec3(q.x, q.y, q.z);
    vec3 b = vec3(axis == 0u ? s : 0.0f, axis == 1u ? s : 0.0f, axis == 2u ? s : 0.0f);
    vec3 v = b * q.w + a * c + cross3(a, b);
    float w = q.w * c - dot3(a, b);
    float k = rsqrtExact(dot3(v, v) + w * w);
    return vec4(v.x * k, v.y * k, v.z * k, w * k);
}

// False: there is no surface.
FN bool turtleAt(SurfaceBuf surfaces, PatternScope scope, OUT(Turtle) t) {
    t.lift = scope.lift;
    t.turn = scope.turn;
    t.size = scope.size;
    return resumeWalk(surfaces, 0u, scope.walk, t.w);
}
FN PatternScope scopeOf(Turtle t) {
    PatternScope s = {};
    s.walk = t.w.walk;
    s.lift = t.lift;
    s.turn = t.turn;
    s.size = t.size;
    return s;
}

FN vec3 leftOf(WalkState w) { return cross3(w.normal, w.walk.direction); }
// A direction in the frame (heading, left, outside), in object space.
FN vec3 fromFrame(WalkState w, vec3 v) { return w.walk.direction * v.x + leftOf(w) * v.y + w.normal * v.z; }

FN FieldRef fieldOf(PatternEnv env, uint grammar, uint instance, uint field) {
    return env.fields.v[(grammar * env.instances + instance) * kMaxFields + field];
}

// What a field says where w stands, seen from the tangent direction `along`.
FN FieldSample fieldSeen(PatternEnv env, FieldRef field, WalkState w, vec3 along) {
    uint place = w.walk.place;
    return fieldAt(env.surfaces, field, place >> 16u, place & 0xFFFFu, w.walk.uv, w.normal, along);
}

// Metres of the world from a texel to the next where w stands.
FN float texelMetres(SurfaceBuf surfaces, WalkState w) {
    uint instance = w.walk.place >> 16u;
    float side = sqrtExact(smaller(dot3(w.du, w.du), dot3(w.dv, w.dv)));
    return side * rcpExact(float(levelSize(surfaces, instance, 0u))) * surfaceScale(surfaces, instance);
}

// Metres of the world that a step along a field may have here.
FN float traceStep(SurfaceBuf surfaces, WalkState w, float rate) {
    uint instance = w.walk.place >> 16u;
    float least = 1e-4f * surfaceRadius(surfaces, instance) * surfaceScale(surfaces, instance);
    float step = kTraceTexels * texelMetres(surfaces, w);
    step = smaller(step, kTraceTurn * rcpExact(larger(absolute(rate), 1e-6f)));
    return larger(step, least);
}

// What the four texels around a walk say of a place about which the field turns.
struct MetSingularity {
    float free;      // metres of the world within which there is none: half of how far it is, about
    bool found;      // it lies between them,
    float angle;     // to there from the heading
    float distance;  // metres of the world
    float sense;     // 1: the field turns about it the way one goes around it, as about a wedge; -1: the other way
};

// Where the bilinear mix of the four texels' N-th powers is 0, by Newton's method.
FN MetSingularity singularityAt(SurfaceBuf surfaces, FieldRef field, WalkState w) {
    uint instance = w.walk.place >> 16u;
    Cell c = cellAt(float(field.size), w.walk.uv);
    vec2 z[4];
    bool owned = true;
    for (uint i = 0u; i < 4u; ++i) {
        uint at = i == 0u ? c.at00 : i == 1u ? c.at10 : i == 2u ? c.at01 : c.at11;
        owned = owned && texelOwned(readTexel(surfaces, instance, 0u, at).bits, w.walk.place & 0xFFFFu);
        float angle = angleBetween(w.normal, w.walk.direction, unpackOct(field.texels.v[at].direction));
        float s = 0.0f;
        float k = 0.0f;
        sinCosExact(angle * float(field.symmetry), s, k);
        z[i] = vec2(k, s);
    }
    vec2 twist = z[0] - z[1] - z[2] + z[3];
    float x = c.fx;
    float y = c.fy;
    float det = 0.0f;
    for (uint i = 0u; i < 4u; ++i) {
        vec2 alongX = z[1] - z[0] + twist * y;
        vec2 alongY = z[2] - z[0] + twist * x;
        vec2 value = z[0] + alongX * x + (z[2] - z[0]) * y;
        det = cross2(alongX, alongY);
        float k = absolute(det) > 1e-6f ? divExact(1.0f, det) : 0.0f;
        x = limited(x - cross2(value, alongY) * k, -1.0f, 2.0f);
        y = limited(y - cross2(alongX, value) * k, -1.0f, 2.0f);
    }
    float change =
        larger(larger(length2(z[1] - z[0]), length2(z[2] - z[0])), larger(length2(z[3] - z[1]), length2(z[3] - z[2])));
    float texel = rcpExact(float(field.size));
    vec3 there = (w.du * (x - c.fx) + w.dv * (y - c.fy)) * texel;
    MetSingularity found = {};
    found.free = divExact(0.5f * texelMetres(surfaces, w), larger(change, 1e-3f));
    found.angle = angleBetween(w.normal, w.walk.direction, there);
    found.distance = sqrtExact(dot3(there, there)) * surfaceScale(surfaces, instance);
    found.sense = det * w.orientation > 0.0f ? 1.0f : -1.0f;
    found.found = owned && absolute(det) > 1e-6f && absolute(x - 0.5f) <= 0.5f && absolute(y - 0.5f) <= 0.5f;
    return found;
}

CONST_UINT(kTraceOn, 0u);      // a way goes on along the field,
CONST_UINT(kTraceJumps, 1u);   // to behind a singularity,
CONST_UINT(kTraceBehind, 2u);  // behind one, where directions don't agree yet

// A way along a field.
struct Trace {
    float offset;  // what leads from the heading to the field, against the sense of turning
    float rate;    // radians a metre
    uint phase;    // kTrace...
    float reach;   // metres of the next step at most; of a jump exactly
    float after;   // by how much the heading turns after a jump
};

// How the heading turns at the end of a step, radians.
FN float turnToField(PatternEnv env, FieldRef field, uint guide, float step, WalkState w, INOUT(Trace) t) {
    FieldSample f = fieldSeen(env, field, w, w.walk.direction);
    uint phase = t.phase;
    uint unsure = phase == kTraceOn ? kTraceOn : kTraceBehind;
    t.phase = f.sure >= kTraceSure ? kTraceOn : unsure;
    float turn = nearestTurn(f.angle + t.offset, float(field.symmetry));
    turn = f.sure >= kTraceSure || t.phase == kTraceBehind ? turn : 0.0f;
    t.rate = divExact(turn, step);
    if (phase == kTraceJumps) {
        turn = t.after;
        t.rate = 0.0f;
        t.offset = turn - f.angle;
    } else if (guide == kGuideJumps) {
        MetSingularity s = singularityAt(env.surfaces, field, w);
        t.reach = s.free;
        if (s.found && f.sure < kTraceSure && t.phase == kTraceOn) {
            // Where the last step has led past it, the way is behind it already.
            bool ahead = absolute(s.angle) < 0.5f * kPi;
            float line = ahead ? s.angle : nearestTurn(s.angle + kPi, 1.0f);
            t.after = line * s.sense;
            turn = ahead ? line : line + t.after;
            t.rate = 0.0f;
            t.reach = ahead ? 2.0f * s.distance : t.reach;
            t.phase = ahead ? kTraceJumps : kTraceBehind;
            t.offset = ahead ? t.offset : turn - f.angle;
        }
    }
    return turn;
}

// Walks `length` metres of the world such that the heading keeps its angle to the field; without one, straight on.
// Turns ahead by half of what the last step turned (a second-order method of Adams and Bashforth). guide: kGuide...
// False: the surface ends.
//
// At a singularity the directions around don't agree. By default the way goes straight on there, and then takes the
// nearest of the field's directions that are at its angle. A way that jumps goes through the singularity to as far
// behind it. Its heading lies to that line as it lay before or, where the field turns the way one goes around,
// mirrored; from there on it keeps the angle to the field that it has there.
FN bool walkAlong(PatternEnv env, uint grammar, uint guide, INOUT(WalkState) w, float length) {
    bool guided = guide != kGuideNone;
    Trace t = {};
    t.reach = guide == kGuideJumps ? 0.5f * texelMetres(env.surfaces, w) : length;
    if (guided) {
        FieldRef field = fieldOf(env, grammar, w.walk.place >> 16u, 0u);
        t.offset = field.symmetry != 0u ? -fieldSeen(env, field, w, w.walk.direction).angle : 0.0f;
    }
    float remaining = length;
    bool stands = true;
    for (uint i = 0u; i < kTraceSteps && stands && remaining > 0.0f; ++i) {
        float step = smaller(remaining, t.reach);
        if (guided && t.phase != kTraceJumps) step = smaller(step, traceStep(env.surfaces, w, t.rate));
        float ahead = limited(0.5f * t.rate * step, -kTraceTurn, kTraceTurn);
        if (guided) rotateHeading(w, ahead);
        stands = walkStep(env.surfaces, 0u, w, step) == kWalkDone;
        remaining = remaining - step;
        if (guided && stands) {
            rotateHeading(w, -ahead);
            float turn = 0.0f;
            t.rate = 0.0f;
            FieldRef field = fieldOf(env, grammar, w.walk.place >> 16u, 0u);
            if (field.symmetry != 0u)
                turn = turnToField(env, field, guide, step, w, t);
            else
                t.phase = kTraceOn;
            rotateHeading(w, turn);
        }
    }
    return stands;
}
ESPALIER_END
#endif
