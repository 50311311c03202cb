#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/extensions.glsl"
// The sky where nothing else is: horizon to zenith, a haze around the sun; over a ground also hills far away.
#include "shaders/render/sky.glsl"
#include "shaders/render/tone.glsl"

layout(push_constant, scalar) uniform Data { PostPush push; };
layout(set = 0, binding = 0) uniform sampler2D noise;
layout(location = 0) out vec4 color;

const float kHighestHill = 0.075;   // sine of its height over the horizon

// Three ranges, each farther one paler.
vec3 hills(vec3 ray, vec3 sky) {
    vec2 to = normalize(ray.xz);
    vec3 seen = sky;
    for (int range = 2; range >= 0; --range) {
        float far = float(range);
        vec4 high = textureLod(noise, to * (0.24 - 0.07 * far) + 0.37 * far, 0.0) - 0.5;
        vec4 trees = textureLod(noise, to * 2.1 + 0.11 * far, 0.0) - 0.5;
        // Broad swells, hills on them, and near by the tops of woods.
        float crest = 0.013 + 0.011 * far + (0.045 + 0.012 * far) * high.x + (0.030 - 0.006 * far) * high.z + (0.010 - 0.0045 * far) * trees.x;
        // The first is never without woods, so that the plain has no bare edge.
        if (range == 0) crest = max(crest, 0.0045 + 0.004 * trees.z + 0.006 * trees.x);
        vec3 wood = farLand(ray, far) * (1.0 + (0.5 - 0.2 * far) * trees.x * clamp(ray.y * 120.0, 0.0, 1.0));
        seen = mix(seen, wood, clamp((crest - ray.y) * 700.0, 0.0, 1.0));
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
    if (rest ? ray.y >= kHighestHill : push.ground != 0u && ray.y < kHighestHill) discard;
    vec3 seen = skyColor(ray);
    if (ray.y > 0.02) seen = clouds(ray, seen);
    if (rest) seen = hills(ray, seen);
    color = stored(toneMapped(seen * frame.exposure), 0.0);
    if (frame.view == kViewOverdraw) color = vec4(0.0);
}
