#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/extensions.glsl"
// Some of a cell's bins each.
#include "shaders/emit/bind.glsl"

layout(local_size_x = 64) in;
layout(constant_id = kConstantLanes) const uint kSortLanes = 1u;   // a cell's
layout(set = 0, binding = 0) uniform usamplerBuffer spanTexels;
layout(set = 0, binding = 1) uniform usamplerBuffer leafTexels;

uvec4 spanTexel(uint i) { return texelFetch(spanTexels, int(i)); }
uvec4 leafTexel(uint i) { return texelFetch(leafTexels, int(i)); }
#include "shaders/emit/sort_bins.h"

void main() {
    uint i = itemIndex();
    uint cell = i / kSortLanes;
    if (cell >= kAllCells || push.cells.v[cell].count == 0u) return;
    if (push.partly == 0u || push.cells.v[cell].changed != 0u) sortBins(cell, i % kSortLanes, kSortLanes);
}
