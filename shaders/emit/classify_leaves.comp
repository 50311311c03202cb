#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/extensions.glsl"
// A loose terminal of a block each: is it seen, at which LOD and how large?
#include "shaders/emit/block.glsl"
#include "shaders/emit/leaf_thinning.glsl"
#include "shaders/emit/sight.glsl"
#include "shaders/shared/leaf_pose.h"

layout(local_size_x = 64) in;
layout(set = 0, binding = 2) uniform usamplerBuffer leafTexels;

void main() {
    uint count = min(push.state.v[0].listed[1] - groupIndex() * kBlockItems, kBlockItems);
    uint block = push.state.v[0].blocks[0] + groupIndex();
    uint lane = gl_LocalInvocationID.x;
    DrawnItem o = DrawnItem(0u, 0u, 1.0, 0u);
    uint bucket = kNoBucket;
    for (bool there = lane < count; there; there = false) {
        o.item = push.list.v[block * kBlockItems + lane] - push.leafBase;
        vec3 origin = uintBitsToFloat(texelFetch(leafTexels, int(4u * o.item)).xyz);
        uvec4 d = texelFetch(leafTexels, int(4u * o.item + 3u));
        KindRecord kind = table.kinds[(d.w >> 8u) & 255u];
        uint variant = kind.firstVariant + (d.z >> 3u) % kind.variantCount;
        bucket = table.variants[variant].firstBucket;
        for (bool culled = (view.flags & kFullDetail) == 0u; culled; culled = false) {
            float size = decodeLeafSize(d.w & 255u);
            float pixels = pixelsPerMetre(view, origin) * size;
            float share = leafShare(view, pixels);
            o.value = leafGrowth(share);
            float reach = size * o.value * table.variants[variant].extent;
            bool seen = leafIsKept(share, d.z) && !outside(view, origin, reach);
            for (bool asked = seen && u64(view.tiles) != 0ul; asked; asked = false) seen = !hidden(view, origin, reach);
            uint lod = table.variants[variant].lodCount - 1u;
            while (lod > 0u && table.variants[variant].error[lod] * pixels > view.lodPixels) --lod;
            bucket = seen ? bucket + lod : kNoBucket;
            o.bits = lod;
        }
    }
    noteItem(block, count, o, bucket);
}
