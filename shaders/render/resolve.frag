#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/extensions.glsl"
// Samples -> pixels, with ambient occlusion.
#include "shaders/render/frame.glsl"
#include "shaders/render/encode.glsl"
#include "shaders/render/heat.h"
#include "shaders/render/open.glsl"
#include "shaders/render/tone.glsl"

layout(push_constant, scalar) uniform Data { PostPush push; };
layout(set = 0, binding = 0) uniform sampler2DMS colorMap;
layout(set = 0, binding = 1) uniform sampler2D openMap;
layout(location = 0) out vec4 color;

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    vec4 c = (texelFetch(colorMap, at, 0) + texelFetch(colorMap, at, 1) + texelFetch(colorMap, at, 2) +
              texelFetch(colorMap, at, 3)) * 0.25;
    float open = openAt(openMap, gl_FragCoord.xy, 2.0 * push.rcpSize);
    if (explains && frame.view == kViewOverdraw) c = stored(heatColor(c.x / (kOverdrawStep * kHottestOverdraw)), 0.0);
    color = pictureColor(c, open, push.encode != 0u, at);
}
