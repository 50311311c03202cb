#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/extensions.glsl"
// A node each: its span, its bin and the chain of its leaves.
#include "shaders/emit/carry.glsl"
#include "records/emit_records.h"

layout(local_size_x = 64) in;
layout(set = 0, binding = 0) uniform usamplerBuffer spanTexels;

void main() {
    uint i = itemIndex();
    uint to = kNoIndex;
    if (i < push.nodeCount) to = nodeNow(i);
    if (to != kNoIndex) {
        PairBuf span = PairBuf(uint64_t(push.spansTo) + uint64_t(to) * (4u * kSpanInstance_words));
        for (uint k = 0u; k < kSpanInstance_words / 4u; ++k) {
            uvec4 texel = texelFetch(spanTexels, int(kSpanInstance_words / 4u * i + k));
            span.v[2u * k] = packUint2x32(texel.xy);
            span.v[2u * k + 1u] = packUint2x32(texel.zw);
        }
        push.keysTo.v[to] = push.keys.v[i];
        push.leafHeadsTo.v[to] = linkNow(push.leafHeads.v[i]);
    }
}
