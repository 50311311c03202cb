#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/extensions.glsl"
// A node each.
#include "shaders/emit/bind.glsl"
#include "shaders/emit/sight.h"

layout(local_size_x = 64) in;
layout(set = 0, binding = 0, scalar) uniform TableBlock { EmitTable table; };
layout(set = 0, binding = 1) uniform usamplerBuffer spanTexels;

uvec4 spanTexel(uint i) { return texelFetch(spanTexels, int(i)); }
#include "shaders/emit/bind_stretch.h"

void main() {
    uint count = nodesToBind();
    for (uint i = FIRST_LANE; i < count; i += LANES) bindStretch(nodeToBind(i));
}
