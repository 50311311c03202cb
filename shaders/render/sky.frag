#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/extensions.glsl"
// The sky where nothing else is: horizon to zenith, a haze around the sun; over a ground also hills far away.
#include "shaders/render/sky.glsl"
#include "shaders/render/tone.glsl"

layout(push_constant, scalar) uniform Data { PostPush push; };
layout(set = 0, binding = 0) uniform sampler2D noise;
layout(set = 0, binding = 1) uniform sampler2D skyline;   // Ground::skylineBinding()
layout(location = 0) out vec4 color;

// A direction as texture u: along the sides of a square on its corner, from +x over +z.
float around(vec2 to) {
    float x = to.x / (abs(to.x) + abs(to.y));
    return to.y >= 0.0 ? 0.25 - 0.25 * x : 0.75 + 0.25 * x;
}

// Three ranges, each farther one paler.
vec3 hills(vec3 ray, vec3 sky) {
    vec4 line = textureLod(skyline, vec2(around(ray.xz), 0.5), 0.0);
    float woods = (line.w - 0.5) * clamp(ray.y * 120.0, 0.0, 1.0);
    vec3 seen = sky;
    for (int range = 2; range >= 0; --range) {
        float far = float(range);
        vec3 wood = farLand(ray, far) * (1.0 + (0.5 - 0.2 * far) * woods);
        seen = mix(seen, wood, clamp((line[range] * kHighestHill - ray.y) * 700.0, 0.0, 1.0));
    }
    return seen;
}

// Thin fair-weather clouds on a plane high above, their rims lit by the sun.
vec3 clouds(vec3 ray, vec3 sky) {
    vec2 at = ray.xz / (ray.y + 0.16) * 0.115;
    float wide = textureLod(noise, at * vec2(0.55, 1.0) + 0.31, 0.0).x, small = textureLod(noise, at * 2.7 + 0.13, 0.0).x;
    float thick = clamp((wide + 0.38 * small - 0.72) * 3.2, 0.0, 1.0) * clamp(ray.y * 9.0 - 0.15, 0.0, 1.0);
    float glow = 0.5 + 0.5 * dot(ray, frame.sunDirection);
    vec3 white = frame.horizon * (1.02 + 0.10 * glow) + frame.sunColor * (0.05 * glow * glow) * (1.0 - 0.4 * thick);
    return mix(sky, white, 0.78 * thick);
}

void main() {
    vec2 at = gl_FragCoord.xy * push.rcpSize * 2.0 - 1.0;
    vec3 ray = normalize(frame.rayForward + frame.rayRight * at.x - frame.rayUp * at.y);
    vec3 seen = skyColor(ray);
    if (ray.y > 0.02 && frame.studioRadius == 0.0) seen = clouds(ray, seen);
    if (rest) seen = hills(ray, seen);   // the program for pictures with a ground
    color = stored(toneMapped(seen * frame.exposure), 0.0);
    if (frame.view == kViewOverdraw) color = vec4(0.0);
}
