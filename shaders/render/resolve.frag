#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/extensions.glsl"
// Samples -> pixels, with ambient occlusion.
#include "shaders/render/frame_records.h"

layout(push_constant, scalar) uniform Data { PostPush push; };
layout(set = 0, binding = 0) uniform sampler2DMS colorMap;
layout(set = 0, binding = 1) uniform sampler2D openMap;
layout(location = 0) out vec4 color;

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    vec4 c = (texelFetch(colorMap, at, 0) + texelFetch(colorMap, at, 1) + texelFetch(colorMap, at, 2) +
              texelFetch(colorMap, at, 3)) * 0.25;
    float open = texture(openMap, gl_FragCoord.xy * push.rcpSize).x;
    vec3 x = c.rgb * c.rgb * (1.0 - c.a * (1.0 - open));
    if (push.encode != 0u)
        x = mix(x * 12.92, 1.055 * pow(max(x, vec3(1e-6)), vec3(1.0 / 2.4)) - 0.055, greaterThan(x, vec3(0.0031308)));
    // Half a step of noise, the same on every run, so that the sky shows no bands.
    uint h = (uint(at.x) * 0x9E3779B1u) ^ (uint(at.y) * 0x85EBCA77u);
    h = (h ^ (h >> 15u)) * 0x2C1B3C6Du;
    color = vec4(x + (float(h >> 24u) * (1.0 / 255.0) - 0.5) * (1.0 / 255.0), 1.0);
}
