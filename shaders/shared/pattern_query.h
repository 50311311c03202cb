// What a grammar asks of fields where a turtle stands: what they say there, and how that changes over the surface
// (Li 2011 §4.3).
#ifndef ESPALIER_SHARED_PATTERN_QUERY_H
#define ESPALIER_SHARED_PATTERN_QUERY_H
#include "shaders/shared/pattern_scope.h"

ESPALIER_BEGIN

// The scope's x axis, laid into the surface.
FN vec3 xAxisOf(Turtle t) {
    return tangentOf(fromFrame(t.w, turned(t.turn, vec3(1.0f, 0.0f, 0.0f))), t.w.normal);
}

// How three numbers change, along the scope's x axis and to its left.
struct Slope {
    vec3 along, left;
};

// Sums over places that weigh differently: of distances (x, y) along the scope's x axis and to its left, of the
// products xx, xy and yy, of three numbers, and of these by x and by y.
struct SlopeSums {
    float w;
    vec2 d;
    vec3 dd;
    vec3 q, xq, yq;  // what a field says
    vec3 r, xr, yr;  // how it lies
};

// The plane of least squares through three numbers.
FN Slope fitted(SlopeSums s, vec3 q, vec3 xq, vec3 yq) {
    float k = s.w > 0.0f ? rcpExact(s.w) : 0.0f;
    float xx = s.dd.x - s.d.x * s.d.x * k;
    float xy = s.dd.y - s.d.x * s.d.y * k;
    float yy = s.dd.z - s.d.y * s.d.y * k;
    vec3 bx = xq - q * (s.d.x * k);
    vec3 by = yq - q * (s.d.y * k);
    float det = xx * yy - xy * xy;
    // Places in a row say nothing of what lies beside them.
    float inverse = det > 1e-4f * (xx + yy) * (xx + yy) ? rcpExact(det) : 0.0f;
    Slope slope = {};
    slope.along = (bx * yy - by * xy) * inverse;
    slope.left = (by * xx - bx * xy) * inverse;
    return slope;
}

// How a field changes, for each metre of the world: x the angle of its direction in radians, y the mean, z the
// deviator. From the 4 x 4 texels of the chart around the turtle, which weigh the less the farther they lie from it. Of
// a texel's directions the one counts that is nearest to `here`, what the field says at the place, seen from the
// scope's x axis.
//
// What the texels say is laid into the plane of the place. That is the plane of a single triangle, or nearly, and leans
// by half of what the surface turns from it to the next. So the texels' heights over it, and how their directions stand
// out of it, tell what the angles would be in the plane through the texels.
FN Slope slopeAt(PatternEnv env, FieldRef field, Turtle t, FieldSample here) {
    uint instance = t.w.walk.place >> 16u;
    float gx = t.w.walk.uv.x * float(field.size) - 0.5f;
    float gy = t.w.walk.uv.y * float(field.size) - 0.5f;
    uint firstX = uint(inRange(gx - 1.0f, float(field.size) - 4.0f));
    uint firstY = uint(inRange(gy - 1.0f, float(field.size) - 4.0f));
    vec3 axis = xAxisOf(t);
    vec3 left = cross3(t.w.normal, axis);
    SlopeSums s = {};
    for (uint i = 0u; i < 16u; ++i) {
        uint tx = firstX + (i & 3u);
        uint ty = firstY + (i >> 2u);
        uint at = texelRow(field.size, ty) + texelColumn(tx);
        Texel texel = readTexel(env.surfaces, instance, 0u, at);
        FieldTexel said = field.texels.v[at];
        bool inside = texelClass(texel.bits) == kTexelInner && texelChart(texel.bits) == (t.w.walk.place & 0xFFFFu);
        float w = larger(2.0f - absolute(gx - float(tx)), 0.0f) * larger(2.0f - absolute(gy - float(ty)), 0.0f);
        w = inside ? w : 0.0f;
        vec3 offset = texel.position - t.w.position;
        float x = dot3(offset, axis);
        float y = dot3(offset, left);
        vec3 direction = unpackOct(said.direction);
        float dx = dot3(direction, axis);
        float dy = dot3(direction, left);
        float out1 = dot3(direction, t.w.normal);
        vec3 q = vec3(nearestTurn(atan2Exact(dy, dx) - here.angle, float(field.symmetry)), said.mean - here.mean,
                      said.deviator - here.deviator);
        vec3 r = vec3(dot3(offset, t.w.normal), out1 * dx, out1 * dy);
        s.w = s.w + w;
        s.d = s.d + vec2(x, y) * w;
        s.dd = s.dd + vec3(x * x, x * y, y * y) * w;
        s.q = s.q + q * w;
        s.xq = s.xq + q * (x * w);
        s.yq = s.yq + q * (y * w);
        s.r = s.r + r * w;
        s.xr = s.xr + r * (x * w);
        s.yr = s.yr + r * (y * w);
    }
    Slope slope = fitted(s, s.q, s.xq, s.yq);
    Slope lean = fitted(s, s.r, s.xr, s.yr);
    slope.along.x = slope.along.x + lean.left.x * lean.along.y - lean.along.x * lean.along.z;
    slope.left.x = slope.left.x + lean.left.x * lean.left.y - lean.along.x * lean.left.z;
    float k = rcpExact(surfaceScale(env.surfaces, instance));
    slope.along = slope.along * k;
    slope.left = slope.left * k;
    return slope;
}

// Values in the measure of the world: a tensor is in 1/m of object space, a direction without a size has no mean.
FN float worldMeasure(PatternEnv env, uint instance, FieldSample here) {
    return here.mean != 0.0f ? rcpExact(surfaceScale(env.surfaces, instance)) : 1.0f;
}

FN float slopeQuantity(Slope s, uint quantity, float measure) {
    bool left = quantity == kQueryTurnY || quantity == kQueryGrowth1Y || quantity == kQueryGrowth2Y;
    vec3 q = left ? s.left : s.along;
    float growth = (q.y + (quantity >= kQueryGrowth2X ? -q.z : q.z)) * measure;
    return quantity >= kQueryGrowth1X ? growth : q.x;
}

FN float sampleQuantity(FieldSample s, uint quantity, float symmetry, float measure) {
    float angle = quantity == kQueryAngle2 ? s.angle + 0.5f * kPi : s.angle;
    float value = (s.mean + (quantity == kQueryValue2 ? -s.deviator : s.deviator)) * measure;
    bool asksAngle = quantity == kQueryAngle1 || quantity == kQueryAngle2;
    return asksAngle ? nearestTurn(angle, symmetry) : quantity == kQuerySure ? s.sure : value;
}

// Fills the slots of the grammar's queries that `inputs` name. Queries of one field follow each other, mostly.
FN void askFields(MACHINE_PARAM PatternEnv env, uint grammar, uint inputs, Turtle t) {
    uint seen = kNoIndex;  // the field that has been looked at, and that whose slope is known
    uint sloped = kNoIndex;
    FieldSample here = {};
    Slope slope = {};
    uint queries = (inputs & kInputFields) != 0u ? env.grammars.v[grammar].queryCount : 0u;
    for (uint i = 0u; i < queries; ++i) {
        uint query = env.grammars.v[grammar].queries.v[i];
        uint f = queryField(query);
        bool slopes = queryOfSlope(query) && (inputs & kInputSlopes) != 0u;
        FieldRef field = fieldOf(env, grammar, t.w.walk.place >> 16u, f);
        bool given = field.symmetry != 0u;
        if (given && f != seen) here = fieldSeen(env, field, t.w, xAxisOf(t));
        if (given && slopes && f != sloped) slope = slopeAt(env, field, t, here);
        seen = f;
        sloped = slopes ? f : sloped;
        float measure = worldMeasure(env, t.w.walk.place >> 16u, here);
        float value = slopes ? slopeQuantity(slope, queryQuantity(query), measure)
                             : sampleQuantity(here, queryQuantity(query), float(field.symmetry), measure);
        SET_SLOT(kSlotQuery + i, given ? value : 0.0f);
    }
}

ESPALIER_END
#endif
