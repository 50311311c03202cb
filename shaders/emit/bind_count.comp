#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/extensions.glsl"
// Items are counted in their bins, and how far and how large they are in their cells.
#include "shaders/emit/bind.glsl"
#include "shaders/shared/leaf_pose.h"

layout(local_size_x = 64) in;
layout(set = 0, binding = 0, scalar) uniform TableBlock { EmitTable table; };
layout(set = 0, binding = 1) uniform usamplerBuffer spanTexels;
layout(set = 0, binding = 2) uniform usamplerBuffer leafTexels;

void count(uint item, uint key) {
    uint cell = key / kCellBins;
    vec3 center;
    float large;
    float reach;
    if (item < push.leafBase) {
        uvec4 d = texelFetch(spanTexels, int(6u * item + 3u));
        vec4 sphere = uintBitsToFloat(texelFetch(spanTexels, int(6u * item + 5u)));
        center = sphere.xyz;
        large = max(uintBitsToFloat(d.z), uintBitsToFloat(d.w));
        reach = sphere.w + 2.0 * large;
    } else {
        int leaf = int(4u * (item - push.leafBase));
        uvec4 d = texelFetch(leafTexels, leaf + 3);
        KindRecord kind = table.kinds[(d.w >> 8u) & 255u];
        center = uintBitsToFloat(texelFetch(leafTexels, leaf).xyz);
        large = decodeLeafSize(d.w & 255u);
        reach = large * table.variants[kind.firstVariant + (d.z >> 3u) % kind.variantCount].extent;
    }
    atomicAdd(push.bins.v[key], 1u);
    atomicMax(push.cells.v[cell].reach, floatBitsToUint(distance(center, cellMiddle(push.grid, cell % kMaxCells)) + reach));
    atomicMax(push.cells.v[cell].largest, floatBitsToUint(large));
}

void main() {
    uint lanes = gl_NumWorkGroups.x * gl_WorkGroupSize.x;
    uint items = itemsToPut();
    for (uint i = gl_GlobalInvocationID.x; i < items; i += lanes) {
        uint item = itemToPut(i);
        uint key = push.keys.v[item];
        if (key != kNoIndex) count(item, key & ~kFresh);
    }
}
