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

// Metres of the world that a step along a field may have here.
FN float traceStep(SurfaceBuf surfaces, WalkState w, float rate) {
    uint instance = w.walk.place >> 16u;
    float side = sqrtExact(smaller(dot3(w.du, w.du), dot3(w.dv, w.dv)));
    float texel = side * rcpExact(float(levelSize(surfaces, instance, 0u))) * surfaceScale(surfaces, instance);
    float least = 1e-4f * surfaceRadius(surfaces, instance) * surfaceScale(surfaces, instance);
    float step = kTraceTexels * texel;
    step = smaller(step, kTraceTurn * rcpExact(larger(absolute(rate), 1e-6f)));
    return larger(step, least);
}

// Walks `length` metres of the world such that the heading keeps its angle to the field; without one, straight on. Turns
// ahead by half of what the last step turned (a second-order method of Adams and Bashforth). False: the surface ends.
FN bool walkAlong(PatternEnv env, uint grammar, bool guided, INOUT(WalkState) w, float length) {
    float offset = 0.0f;
    if (guided) {
        FieldRef field = fieldOf(env, grammar, w.walk.place >> 16u, 0u);
        offset = field.symmetry != 0u ? -fieldSeen(env, field, w, w.walk.direction).angle : 0.0f;
    }
    float rate = 0.0f;   // radians a metre
    float remaining = length;
    bool stands = true;
    for (uint i = 0u; i < kTraceSteps && stands && remaining > 0.0f; ++i) {
        float step = guided ? smaller(remaining, traceStep(env.surfaces, w, rate)) : remaining;
        float ahead = limited(0.5f * rate * step, -kTraceTurn, kTraceTurn);
        if (guided) rotateHeading(w, ahead);
        stands = walkStep(env.surfaces, 0u, w, step) == kWalkDone;
        remaining = remaining - step;
        if (guided && stands) {
            rotateHeading(w, -ahead);
            float turn = 0.0f;
            FieldRef field = fieldOf(env, grammar, w.walk.place >> 16u, 0u);
            if (field.symmetry != 0u) {
                FieldSample f = fieldSeen(env, field, w, w.walk.direction);
                turn = f.sure >= kTraceSure ? nearestTurn(f.angle + offset, float(field.symmetry)) : 0.0f;
            }
            rotateHeading(w, turn);
            rate = divExact(turn, step);
        }
    }
    return stands;
}
ESPALIER_END
#endif
