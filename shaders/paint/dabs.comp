#version 460
#extension GL_GOOGLE_include_directive : require
// Dabs, in order, on the texels of the blocks that they may reach. Gutter texels are painted by their own positions,
// so that bilinear reads on both sides of a seam agree.
#include "shaders/shared/extensions.glsl"
#include "shaders/shared/dispatch.glsl"
#include "shaders/paint/brush.h"

layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { PaintEnv env; };
layout(binding = 0, scalar) uniform Stroke {
    BrushRecord brush;
    DabRecord dabs[kDabsAtOnce];
};
#include "shaders/paint/place.glsl"

void main() {
    uint item = itemIndex();
    if (item >= env.count * kBlockTexels) return;
    uint i = env.blocks.v[item / kBlockTexels] * kBlockTexels + item % kBlockTexels;
    Texel texel = env.texels.v[i];
    if (texelClass(texel.bits) == kTexelEmpty) return;
    vec3 p = worldPosition(texel.position);
    vec3 n = vec3(0.0);
    if ((brush.flags & (kBrushSlope | kBrushFront)) != 0u) n = worldNormal(env.aux.v[i].normal);
    float before = env.layer.v[i];
    float value = before;
    for (uint d = 0u; d < brush.dabs; ++d) value = towards(value, brush.target, dabWeight(brush, dabs[d], p, n));
    if (value != before) env.layer.v[i] = value;
}
