#version 460
#extension GL_GOOGLE_include_directive : require
// One dab of smoothing: texels go towards the mean of six places around them, which a walk finds wherever the surface
// leads, over seams too. Then gutter texels take what lies on the far side of their seam, so that reads on both sides
// agree. Results go beside the layer first, kBlocksUntouched where there is none.
#include "shaders/shared/extensions.glsl"
#include "shaders/shared/dispatch.glsl"
#include "shaders/paint/block_records.h"
#include "shaders/shared/walk.h"

layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { PaintEnv env; };
layout(binding = 0, scalar) uniform Stroke {
    BrushRecord brush;
    DabRecord dabs[kDabsAtOnce];
};
#include "shaders/paint/place.glsl"

const uint kNeighbours = 6u;
const float kNeighbourAngle = 1.04719755;

// Bilinear over the inner texels around uv; false where there is none.
bool innerAt(uint size, vec2 uv, out float value) {
    vec2 g = uv * float(size) - 0.5;
    uvec2 low = uvec2(inRange(g.x, float(size) - 2.0), inRange(g.y, float(size) - 2.0));
    vec2 f = vec2(limited(g.x - float(low.x), 0.0, 1.0), limited(g.y - float(low.y), 0.0, 1.0));
    float sum = 0.0;
    float weight = 0.0;
    for (uint k = 0u; k < 4u; ++k) {
        uint i = texelIndex(size, low.x + (k & 1u), low.y + (k >> 1u));
        float w = ((k & 1u) != 0u ? f.x : 1.0 - f.x) * (k >> 1u != 0u ? f.y : 1.0 - f.y) + 1e-3;
        if (texelClass(env.texels.v[i].bits) != kTexelInner) continue;
        sum += env.layer.v[i] * w;
        weight += w;
    }
    value = sum * rcpExact(weight);
    return weight > 0.0;
}

// The layer's value so many metres along the walk's heading. Where no border is so near, straight over the chart.
bool valueAlong(uint size, WalkState w, float metres, out float value) {
    vec2 step = tangentRate(w.du, w.dv, w.walk.direction) * (metres * env.perScale);
    if (length2(step) < w.clear) return innerAt(size, w.walk.uv + step, value);
    float remaining = metres;
    uint event = kWalkRetry;
    vec3 normal;
    while (walkGoesOn(event)) event = walkAdvance(env.surfaces, 0u, w, remaining, normal);
    // Another surface's layer is another's; what this one has is read.
    return event != kWalkLost && w.walk.place >> 16u == env.instance && innerAt(size, w.walk.uv, value);
}

float smoothed(uint size, uint chart, vec2 uv, float value, float share) {
    WalkState w;
    // Any tangent will do to begin with.
    if (!startWalk(env.surfaces, 0u, (env.instance << 16u) | chart, uv, vec3(0.0), w)) return value;
    float sum = 0.0;
    float count = 0.0;
    for (uint k = 0u; k < kNeighbours; ++k) {
        float there;
        if (valueAlong(size, w, brush.reach, there)) {
            sum += there;
            count += 1.0;
        }
        rotateHeading(w, kNeighbourAngle);
    }
    return count > 0.0 ? towards(value, sum * rcpExact(count), share) : value;
}

// What a gutter texel stands for: from the nearest inner texel of its chart, over the border.
bool farSide(uint size, uvec2 at, Texel texel, out float value) {
    float best = 9.0;
    uvec2 from = at;
    for (uint k = 0u; k < 25u; ++k) {
        ivec2 offset = ivec2(int(k % 5u) - 2, int(k / 5u) - 2);
        ivec2 there = ivec2(at) + offset;
        if (any(lessThan(there, ivec2(0))) || any(greaterThanEqual(there, ivec2(int(size))))) continue;
        uint bits = env.texels.v[texelIndex(size, uint(there.x), uint(there.y))].bits;
        float d = float(offset.x * offset.x + offset.y * offset.y);
        if (texelClass(bits) != kTexelInner || texelChart(bits) != texelChart(texel.bits) || d >= best) continue;
        best = d;
        from = uvec2(there);
    }
    if (best > 8.5) return false;
    vec3 way = texel.position - env.texels.v[texelIndex(size, from.x, from.y)].position;
    vec2 uv = (vec2(from) + 0.5) * rcpExact(float(size));
    WalkState w;
    return startWalk(env.surfaces, 0u, (env.instance << 16u) | texelChart(texel.bits), uv, way, w) &&
           valueAlong(size, w, length3(way) * rcpExact(env.perScale), value);
}

void main() {
    uint item = itemIndex();
    if (item >= env.count * kBlockTexels) return;
    uint i = env.blocks.v[item / kBlockTexels] * kBlockTexels + item % kBlockTexels;
    env.result.v[item] = uintBitsToFloat(kBlocksUntouched);
    Texel texel = env.texels.v[i];
    bool gutters = brush.gutters != 0u;
    uint kind = texelClass(texel.bits);
    if (kind == kTexelEmpty || gutters != (kind != kTexelInner)) return;
    vec3 n = vec3(0.0);
    if ((brush.flags & (kBrushSlope | kBrushFront)) != 0u) n = worldNormal(env.aux.v[i].normal);
    float share = dabWeight(brush, dabs[0], worldPosition(texel.position), n);
    if (share <= 0.0) return;
    uint size = env.size;
    uint block = i / kBlockTexels;
    uint inside = i % kBlockTexels;
    uint across = size / 8u;
    uvec2 at = uvec2(block % across * 8u + inside % 8u, block / across * 8u + inside / 8u);
    float value = env.layer.v[i];
    if (gutters) {
        float there;
        if (farSide(size, at, texel, there)) value = there;
    } else {
        value = smoothed(size, texelChart(texel.bits), (vec2(at) + 0.5) * rcpExact(float(size)), value, share);
    }
    if (value != env.layer.v[i]) env.result.v[item] = value;
}
