#version 460
#extension GL_GOOGLE_include_directive : require
// Where smoothing looks from the texels that smooth_places.comp has listed: a walk finds the ends of the six ways
// wherever the surface leads, over seams too. A gutter texel has one place, what it stands for beyond its border.
#include "shaders/shared/extensions.glsl"
#include "shaders/shared/dispatch.glsl"
#include "shaders/shared/walk.h"
#include "shaders/paint/smooth_records.h"

layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { PlacesEnv env; };
#include "shaders/paint/texel_place.glsl"

const float kSixth = 1.04719755;

// Where the walk's heading leads in so many metres; false: nowhere on this surface.
bool placeAlong(WalkState w, float metres, out vec2 uv) {
    vec2 step = tangentRate(w.du, w.dv, w.walk.direction) * (metres * env.perScale);
    uv = w.walk.uv + step;
    if (length2(step) < w.clear) return true;
    float remaining = metres;
    uint event = kWalkRetry;
    vec3 normal = vec3(0.0f);
    while (walkGoesOn(event)) event = walkAdvance(env.surfaces, 0u, w, remaining, normal);
    uv = w.walk.uv;
    // Another surface's layer is another's; what this one has is read.
    return event != kWalkLost && w.walk.place >> 16u == env.instance;
}

void walked(uvec2 at, uint chart, uint to) {
    WalkState w = {};
    vec2 uv = (vec2(at) + 0.5) * rcpExact(float(env.size));
    // Any tangent will do to begin with.
    bool found = startWalk(env.surfaces, 0u, (env.instance << 16u) | chart, uv, vec3(0.0), w);
    for (uint k = 0u; k < kSmoothPlaces; ++k) {
        bool there = found && placeAlong(w, env.reach, uv);
        env.places.v[to + k * kBlockTexels] = there ? packedPlace(uv) : kNoPlace;
        rotateHeading(w, kSixth);
    }
}

// What a gutter texel stands for: from the nearest inner texel of its chart, over the border.
uint farSide(uvec2 at, Texel texel) {
    float best = 9.0;
    uvec2 from = at;
    for (uint k = 0u; k < 25u; ++k) {
        ivec2 offset = ivec2(int(k % 5u) - 2, int(k / 5u) - 2);
        ivec2 there = ivec2(at) + offset;
        if (any(lessThan(there, ivec2(0))) || any(greaterThanEqual(there, ivec2(int(env.size))))) continue;
        uint bits = bitsAt(texelIndex(env.size, uint(there.x), uint(there.y)));
        float d = float(offset.x * offset.x + offset.y * offset.y);
        if (texelClass(bits) != kTexelInner || texelChart(bits) != texelChart(texel.bits) || d >= best) continue;
        best = d;
        from = uvec2(there);
    }
    if (best > 8.5) return kNoPlace;
    vec3 way = texel.position - positionAt(from.x, from.y);
    vec2 uv = (vec2(from) + 0.5) * rcpExact(float(env.size));
    WalkState w = {};
    bool there = startWalk(env.surfaces, 0u, (env.instance << 16u) | texelChart(texel.bits), uv, way, w) &&
                 placeAlong(w, length3(way) * rcpExact(env.perScale), uv);
    return there ? packedPlace(uv) : kNoPlace;
}

void main() {
    uint listed = itemIndex();
    if (listed >= env.walkers.v[0]) return;
    uint item = env.walkers.v[1u + listed];
    Texel texel = env.texels.v[texelOf(item)];
    texel.bits = bitsAt(texelOf(item));
    uvec2 at = whereIs(texelOf(item));
    if (texelClass(texel.bits) == kTexelInner)
        walked(at, texelChart(texel.bits), placesOf(item));
    else
        env.places.v[placesOf(item)] = farSide(at, texel);
}
