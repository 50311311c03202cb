#version 460
#extension GL_GOOGLE_include_directive : require
// See block_records.h. One invocation a texel.
#include "shaders/shared/extensions.glsl"
#include "shaders/shared/dispatch.glsl"
#include "shaders/paint/block_records.h"

layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { BlocksEnv env; };

void main() {
    uint item = itemIndex();
    if (item >= env.count * kBlockTexels) return;
    uint block = item / kBlockTexels;
    uint at = env.blocks.v[block] * kBlockTexels + item % kBlockTexels;
    uint kept = env.first * kBlockTexels + item;
    if (env.job == kBlocksFill) {
        env.layer.v[at] = env.value;
        return;
    }
    if (env.job == kBlocksTake) {
        uint taken = env.kept.v[kept];
        if (taken != kBlocksUntouched) env.layer.v[at] = taken;
        return;
    }
    uint texel = env.layer.v[at];
    if (env.job == kBlocksCompare) {
        if (texel != env.kept.v[kept]) atomicOr(env.marks.v[item / 32u], 1u << (item % 32u));
        return;
    }
    if (env.job == kBlocksSwap) env.layer.v[at] = env.kept.v[kept];
    env.kept.v[kept] = texel;
}
