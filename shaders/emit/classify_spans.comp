#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/extensions.glsl"
// A span of a block each: is its bark seen, at which LOD, how thick and how faint?
#include "shaders/emit/block.glsl"
#include "shaders/emit/sight.glsl"
#include "shaders/emit/span_thinning.glsl"

layout(local_size_x = 64) in;
layout(set = 0, binding = 2) uniform usamplerBuffer spanTexels;

void main() {
    uint block = groupIndex();
    uint count = min(push.state.v[0].listed[0] - block * kBlockItems, kBlockItems);
    uint lane = gl_LocalInvocationID.x;
    DrawnItem o = DrawnItem(0u, 0u, 0.0, 0u);
    uint bucket = kNoBucket;
    for (bool there = lane < count; there; there = false) {
        o.item = push.list.v[block * kBlockItems + lane];
        uvec4 d = texelFetch(spanTexels, int(6u * o.item + 3u));
        uvec4 e = texelFetch(spanTexels, int(6u * o.item + 4u));
        float thick = max(uintBitsToFloat(d.z), uintBitsToFloat(d.w));
        float order = float(e.w >> 16u) * (1.0 / 65535.0);
        uint variant = table.kinds[e.w & 63u].firstVariant;
        o.bits = 0xFFFF0000u;
        bucket = table.variants[variant].firstBucket;
        // No branch on what is the same in all of a view; see cull_cells.comp.
        uint lanes = kBlockItems * (1u - (view.flags & kFullDetail));
        for (bool culled = lane < lanes; culled; culled = false) {
            vec4 sphere = uintBitsToFloat(texelFetch(spanTexels, int(6u * o.item + 5u)));
            vec2 errors = unpackHalf2x16(e.z);
            float stretches = float((view.flags & kStretches) / kStretches);
            bool joined = errors.y * pixelsPerMetre(view, sphere.xyz) <= mix(-1.0, view.lodPixels, stretches);
            for (bool alone = !joined; alone; alone = false) {
                uvec4 a = texelFetch(spanTexels, int(6u * o.item));
                uvec4 b = texelFetch(spanTexels, int(6u * o.item + 1u));
                uvec4 c = texelFetch(spanTexels, int(6u * o.item + 2u));
                sphere = spanSphere(uintBitsToFloat(a.xyz), uintBitsToFloat(uvec3(a.w, b.xy)),
                                    uintBitsToFloat(uvec3(b.zw, c.x)), uintBitsToFloat(c.yzw));
            }
            float pixels = pixelsPerMetre(view, sphere.xyz);
            float thin = thick * pixels / view.leastPixels;
            float reach = sphere.w + 2.0 * max(thick, view.leastPixels / pixels);
            bool seen = (!joined || (e.w & 0x8000u) != 0u) && thin >= kThinnest && spanIsKept(thin, order) && !outside(view, sphere.xyz, reach);
            for (bool asked = seen && u64(view.tiles) != 0ul; asked; asked = false) seen = !hidden(view, sphere.xyz, reach);
            // n straight pieces leave about 1/n² of the bend.
            uint lod = table.variants[variant].lodCount - 1u;
            while (lod > 0u && !joined) {
                float pieces = table.variants[variant].segments[lod];
                if ((table.variants[variant].error[lod] * thick + errors.x / (pieces * pieces)) * pixels <= view.lodPixels) break;
                --lod;
            }
            bucket = seen ? bucket + lod : kNoBucket;
            o.bits = lod | (joined ? (e.w >> 9u) & 56u : 0u) | (uint(spanFade(thin, order) * 65535.0 + 0.5) << 16u);
            o.value = view.leastPixels / pixels;
        }
    }
    noteItem(block, count, o, bucket);
}
