#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/extensions.glsl"
// A span of a block each: is its bark seen, at which LOD, how thick and how faint?
#include "shaders/emit/block.glsl"
#include "shaders/emit/sight.h"
#include "shaders/emit/span_thinning.h"

layout(local_size_x = 64) in;
layout(set = 0, binding = 2) uniform usamplerBuffer spanTexels;

uvec4 spanTexel(uint i) { return texelFetch(spanTexels, int(i)); }
#include "shaders/emit/classify_span.h"

void main() {
    uint block = groupIndex();
    if (block >= push.state.v[0].blocks[0]) return;
    uint count = min(push.state.v[0].listed[0] - block * kBlockItems, kBlockItems);
    uint lane = gl_LocalInvocationID.x;
    DrawnItem o = DrawnItem(0u, 0u, 0.0, 0u);
    uint bucket = kNoBucket;
    if (lane < count)
        bucket = bucketOfSpan(push.list.v[block * kBlockItems + lane], o);
    noteItem(block, count, o, bucket);
}
