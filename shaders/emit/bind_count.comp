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

uvec4 spanTexel(uint i) { return texelFetch(spanTexels, int(i)); }
uvec4 leafTexel(uint i) { return texelFetch(leafTexels, int(i)); }
#include "shaders/emit/count_item.h"

void main() {
    uint items = itemsToPut();
    for (uint i = FIRST_LANE; i < items; i += LANES) countItem(itemToPut(i));
}
