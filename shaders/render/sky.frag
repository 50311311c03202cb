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
        vec4 high = textureLod(noise, to * (0.055 + 0.02 * far) + 0.37 * far, 0.0) - 0.5;
        vec4 trees = textureLod(noise, to * 1.7 + 0.11 * far, 0.0) - 0.5;
        float crest = 0.010 + 0.012 * far + 0.055 * high.x + (0.004 - 0.0015 * far) * trees.x;
        seen = mix(seen, farLand(ray, far), clamp((crest - ray.y) * 900.0, 0.0, 1.0));
    }
    return seen;
}

void main() {
    vec2 at = gl_FragCoord.xy * push.rcpSize * 2.0 - 1.0;
    vec3 ray = normalize(frame.rayForward + frame.rayRight * at.x - frame.rayUp * at.y);
    vec3 seen = skyColor(ray);
    // A loop of one round: a device that runs all lanes through both sides of an `if` does leave a loop early.
    for (bool low = push.ground != 0u && ray.y < kHighestHill; low; low = false) seen = hills(ray, seen);
    color = stored(toneMapped(seen * frame.exposure), 0.0);
    if (frame.view == kViewOverdraw) color = vec4(0.0);
}
