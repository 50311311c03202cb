// A walk's state, and the parts of walking that look at one patch only: tangents, standing, entering, turning (walk.h
// walks). Lengths are metres of the world; directions and positions are in object space.
#ifndef ESPALIER_SHARED_WALK_STATE_H
#define ESPALIER_SHARED_WALK_STATE_H
#include "shaders/shared/growth_records.h"
#include "shaders/shared/surface_lookup.h"

ESPALIER_BEGIN

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
RECORD_WORDS(WalkState)
RECORD_OFFSETS(WalkState)

CONST_UINT(kWalkFlagCrease, 1u << 8u);
CONST_UINT(kWalkFlagLoose, 1u << 9u);
CONST_UINT(kWalkFlagMoved, 1u << 10u);
CONST_UINT(kWalkFlagBend, 1u << 11u);
CONST_UINT(kWalkFlagOver, 1u << 12u);   // came over a crease, and the nearest texels may still be the near side's
CONST_UINT(kWalkFlagBeside, 1u << 13u); // last read was Patch::beside a crease

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
    uint coarsest = 0u;
    readChart(surfaces, instance, chart, w.orientation, coarsest);
    w.level = level < coarsest ? level : coarsest;
    w.limit = 1e30f;
    w.leftUv = w.walk.uv;
    w.leftPlace = walk.place;
    w.slip = vec2(0.0f);
    w.flags = 0u;
    Patch p = {};
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
    Walk walk = {};
    walk.place = place;
    walk.uv = uv;
    float size2 = dot3(direction, direction);
    walk.direction = size2 > 1e-30f ? direction * rsqrtExact(size2) : vec3(0.0f);
    walk.arc = 0.0f;
    return resumeWalk(surfaces, level, walk, w);
}

// Turns the heading by `angle` radians, counterclockwise as seen from outside.
FN void rotateHeading(INOUT(WalkState) w, float angle) {
    float s = 0.0f;
    float c = 0.0f;
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

ESPALIER_END
#endif
