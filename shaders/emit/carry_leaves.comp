#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/extensions.glsl"
// A leaf each: its instance, its bin and the next one on its node.
#include "shaders/emit/carry.glsl"
#include "records/emit_records.h"

layout(local_size_x = 64) in;
layout(set = 0, binding = 0) uniform usamplerBuffer leafTexels;

void main() {
    uint i = itemIndex();
    uint to = kNoIndex;
    if (i < push.leafCount) to = leafNow(i);
    if (to != kNoIndex) {
        PairBuf leaf = PairBuf(uint64_t(push.leavesTo) + uint64_t(to) * (4u * kLeafInstance_words));
        for (uint k = 0u; k < kLeafInstance_words / 4u; ++k) {
            uvec4 texel = texelFetch(leafTexels, int(kLeafInstance_words / 4u * i + k));
            leaf.v[2u * k] = packUint2x32(texel.xy);
            leaf.v[2u * k + 1u] = packUint2x32(texel.zw);
        }
        push.keysTo.v[push.leafBaseTo + to] = push.keys.v[push.leafBase + i];
        push.leafNextTo.v[to] = linkNow(push.leafNext.v[i]);
    }
}
