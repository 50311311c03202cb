#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/extensions.glsl"
// A loose terminal of a block each: is it seen, at which LOD and how large?
#include "shaders/emit/block.glsl"
#include "shaders/emit/leaf_thinning.h"
#include "shaders/emit/sight.h"
#include "shaders/shared/leaf_pose.h"

layout(local_size_x = 64) in;
layout(set = 0, binding = 2) uniform usamplerBuffer leafTexels;

uvec4 leafTexel(uint i) { return texelFetch(leafTexels, int(i)); }
#include "shaders/emit/classify_leaf.h"

void main() {
    if (groupIndex() >= push.state.v[0].blocks[1]) return;
    uint count = min(push.state.v[0].listed[1] - groupIndex() * kBlockItems, kBlockItems);
    uint block = push.state.v[0].blocks[0] + groupIndex();
    uint lane = gl_LocalInvocationID.x;
    DrawnItem o = DrawnItem(0u, 0u, 1.0, 0u);
    uint bucket = kNoBucket;
    if (lane < count)
        bucket = bucketOfLeaf(push.list.v[block * kBlockItems + lane] - push.leafBase, o);
    noteItem(block, count, o, bucket);
}
