#version 460
#extension GL_GOOGLE_include_directive : require
// One dab of smoothing: inner texels go towards the mean of their places (smooth_places.comp). Results go beside the
// layer first, kBlocksUntouched where there is none. Then gutter texels take what lies on the far side of their seam,
// so that reads on both sides agree.
#include "shaders/shared/extensions.glsl"
#include "shaders/shared/dispatch.glsl"
#include "shaders/paint/smooth_records.h"
#include "shaders/shared/surface_lookup.h"

layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { PaintEnv env; };
layout(binding = 0, scalar) uniform Stroke {
    BrushRecord brush;
    DabRecord dabs[kDabsAtOnce];
};
#include "shaders/paint/place.glsl"
#include "shaders/paint/texel_bits.glsl"

// Of several values: a mean is rounded, but lies between them, and is what all of them are.
struct Mean {
    float sum, weight, low, high;
};
Mean noMean() { return Mean(0.0, 0.0, 3e38, -3e38); }
void take(inout Mean m, float value, float weight) {
    m.sum += value * weight;
    m.weight += weight;
    m.low = value < m.low ? value : m.low;
    m.high = value > m.high ? value : m.high;
}
float taken(Mean m) { return limited(m.sum * rcpExact(m.weight), m.low, m.high); }

// Bilinear over the inner texels around a place; false where there is none.
bool between(uint place, out float value) {
    vec2 g = (vec2(place & 0xFFFFu, place >> 16u) + 0.5) * (float(env.size) * (1.0 / 65536.0)) - 0.5;
    uvec2 low = uvec2(inRange(g.x, float(env.size) - 2.0), inRange(g.y, float(env.size) - 2.0));
    vec2 f = vec2(limited(g.x - float(low.x), 0.0, 1.0), limited(g.y - float(low.y), 0.0, 1.0));
    Mean m = noMean();
    for (uint k = 0u; k < 4u; ++k) {
        uint i = texelIndex(env.size, low.x + (k & 1u), low.y + (k >> 1u));
        float w = ((k & 1u) != 0u ? f.x : 1.0 - f.x) * (k >> 1u != 0u ? f.y : 1.0 - f.y) + 1e-3;
        if (texelClass(bitsAt(i)) == kTexelInner) take(m, env.layer.v[i], w);
    }
    value = taken(m);
    return m.weight > 0.0;
}

// The texel that holds a place; at a border a gutter texel, which stands for what is beyond.
float nearest(uint place) {
    return env.layer.v[texelIndex(env.size, (place & 0xFFFFu) * env.size >> 16u, (place >> 16u) * env.size >> 16u)];
}

float meanOf(uint from, float value) {
    uint first = env.places.v[from];
    // Texels of a block lie in rows of 8.
    if (first >= kPlacesOfQuad && first != kNoPlace)
        from = (from & ~9u) + ((first & 1u) != 0u ? 1u : 0u) + ((first & 2u) != 0u ? 8u : 0u);
    Mean m = noMean();
    for (uint k = 0u; k < kSmoothPlaces; ++k) {
        uint place = env.places.v[from + k * kBlockTexels];
        if (place == kNoPlace) continue;
        float there = value;
        if (brush.fine == 0u)
            there = nearest(place);
        else if (!between(place, there))
            continue;
        take(m, there, 1.0);
    }
    return m.weight > 0.0 ? taken(m) : value;
}

void main() {
    uint item = itemIndex();
    if (item >= env.count * kBlockTexels) return;
    uint inside = item % kBlockTexels;
    uint i = env.blocks.v[item / kBlockTexels] * kBlockTexels + inside;
    bool gutters = brush.gutters != 0u;
    if (!gutters) UintBuf(uint64_t(env.result)).v[item] = kBlocksUntouched;
    uint kind = texelClass(bitsAt(i));
    if (kind == kTexelEmpty || gutters != (kind != kTexelInner)) return;
    vec3 n = vec3(0.0);
    if ((brush.flags & (kBrushSlope | kBrushFront)) != 0u) n = worldNormal(env.aux.v[i].normal);
    float share = dabWeight(brush, dabs[0], worldPosition(env.texels.v[i].position), n);
    if (share <= 0.0) return;
    uint from = env.slots.v[item / kBlockTexels] * kSmoothPlaces * kBlockTexels + inside;
    float before = env.layer.v[i];
    if (gutters) {
        uint place = env.places.v[from];
        float there = before;
        // Only inner texels are read, so gutters are written where they lie.
        if (place != kNoPlace && between(place, there) && there != before) env.layer.v[i] = there;
        return;
    }
    float value = towards(before, meanOf(from, before), share);
    if (value != before) env.result.v[item] = value;
}
