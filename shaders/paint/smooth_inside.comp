#version 460
#extension GL_GOOGLE_include_directive : require
// One dab of smoothing where no border is near: texels go towards the mean of the six texels where steps straight over
// the chart end. Results go beside the layer first, kBlocksUntouched where there is none. (smooth.comp walks instead, over
// seams too, which costs many times as much.)
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

float layerAt(vec2 at) {
    float last = float(env.size) - 1.0;
    return env.layer.v[texelIndex(env.size, uint(inRange(at.x, last)), uint(inRange(at.y, last)))];
}

vec3 positionAt(uint x, uint y) { return env.texels.v[texelIndex(env.size, x, y)].position; }

// The mean of six places brush.reach away; nearer ones where the texel's clearance is too small for that.
float meanAround(uvec2 at, uint bits) {
    uvec2 low = max(at, uvec2(1u)) - 1u;
    uvec2 high = min(at + 1u, uvec2(env.size - 1u));
    // Over two texels each, so the rates are in pairs of texels.
    vec3 du = positionAt(high.x, at.y) - positionAt(low.x, at.y);
    vec3 dv = positionAt(at.x, high.y) - positionAt(at.x, low.y);
    float reach = 2.0 * brush.reach * env.perScale;
    vec3 along = unit3(du);
    vec2 a = tangentRate(du, dv, along) * reach;
    vec2 b = tangentRate(du, dv, unit3(cross3(cross3(du, dv), along))) * (reach * 0.8660254);
    vec2 c = a * 0.5 + b;
    vec2 d = b - a * 0.5;
    float longest = larger(larger(length2(a), length2(c)), length2(d));
    float k = smaller(divExact(float(texelClearance(bits)) - 1.0, larger(longest, 1e-3)), 1.0);
    vec2 middle = vec2(at) + 0.5;
    float sum = layerAt(middle + a * k) + layerAt(middle - a * k) + layerAt(middle + c * k) + layerAt(middle - c * k) +
                layerAt(middle + d * k) + layerAt(middle - d * k);
    return sum * (1.0 / 6.0);
}

void main() {
    uint item = itemIndex();
    if (item >= env.count * kBlockTexels) return;
    uint block = env.blocks.v[item / kBlockTexels];
    uint inside = item % kBlockTexels;
    uint i = block * kBlockTexels + inside;
    Texel texel = env.texels.v[i];
    vec3 n = vec3(0.0);
    if ((brush.flags & (kBrushSlope | kBrushFront)) != 0u) n = worldNormal(env.aux.v[i].normal);
    float share = dabWeight(brush, dabs[0], worldPosition(texel.position), n);
    uint across = env.size / 8u;
    uvec2 at = uvec2(block % across * 8u + inside % 8u, block / across * 8u + inside / 8u);
    float before = env.layer.v[i];
    float value = towards(before, meanAround(at, texel.bits), share);
    env.result.v[item] = value != before ? value : uintBitsToFloat(kBlocksUntouched);
}
