#version 460
#extension GL_GOOGLE_include_directive : require
// Where smoothing looks, for blocks that a stroke comes to: from each inner texel the ends of six ways of one length,
// straight over the chart. Texels that have a border too near, and gutter texels, are listed for smooth_walk.comp; where
// ways are long, one of a quad is.
#include "shaders/shared/extensions.glsl"
#include "shaders/shared/dispatch.glsl"
#include "shaders/shared/walk.h"
#include "shaders/paint/smooth_records.h"

layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { PlacesEnv env; };
#include "shaders/paint/texel_place.glsl"

// Six ways straight over the chart; false where a border may be in the way.
bool straight(uvec2 at, uint bits, uint to) {
    uvec2 low = max(at, uvec2(1u)) - 1u;
    uvec2 high = min(at + 1u, uvec2(env.size - 1u));
    // Over two texels each, so the rates are in pairs of texels.
    vec3 du = positionAt(high.x, at.y) - positionAt(low.x, at.y);
    vec3 dv = positionAt(at.x, high.y) - positionAt(at.x, low.y);
    vec3 along = unit3(du);
    float reach = 2.0 * env.reach * env.perScale;
    vec2 a = tangentRate(du, dv, along) * reach;
    vec2 b = tangentRate(du, dv, unit3(cross3(cross3(du, dv), along))) * (reach * 0.8660254);
    vec2 ways[3] = vec2[3](a, a * 0.5 + b, b - a * 0.5);
    float longest = larger(larger(length2(ways[0]), length2(ways[1])), length2(ways[2]));
    if (!(longest < float(texelClearance(bits)) - 1.0)) return false;
    float texel = rcpExact(float(env.size));
    vec2 middle = (vec2(at) + 0.5) * texel;
    for (uint k = 0u; k < 3u; ++k) {
        env.places.v[to + 2u * k * kBlockTexels] = packedPlace(middle + ways[k] * texel);
        env.places.v[to + (2u * k + 1u) * kBlockTexels] = packedPlace(middle - ways[k] * texel);
    }
    return true;
}

// Which of the quad's four texels finds the places: the first that is inner and of this chart. Neighbouring quads begin
// with different ones, or paint would drift a little with each dab.
uint walkerOfQuad(uint texel, uint chart) {
    uint quad = texel & ~9u;
    uint begin = (texel >> 1u & 1u) | (texel >> 3u & 2u);
    for (uint i = 0u; i < 4u; ++i) {
        uint k = (begin + i) & 3u;
        uint bits = bitsAt(quad + (k & 1u) + (k >> 1u) * 8u);
        if (texelClass(bits) == kTexelInner && texelChart(bits) == chart) return k;
    }
    return begin;
}

void main() {
    uint item = itemIndex();
    if (item >= env.count * kBlockTexels) return;
    uint bits = bitsAt(texelOf(item));
    uint kind = texelClass(bits);
    if (kind == kTexelEmpty) return;
    bool inner = kind == kTexelInner;
    if (inner && straight(whereIs(texelOf(item)), bits, placesOf(item))) return;
    if (inner && env.quads != 0u) {
        uint walker = walkerOfQuad(texelOf(item), texelChart(bits));
        if (walker != ((item & 1u) | (item >> 2u & 2u))) {
            env.places.v[placesOf(item)] = kPlacesOfQuad | walker;
            return;
        }
    }
    env.walkers.v[1u + atomicAdd(env.walkers.v[0], 1u)] = item;
}
