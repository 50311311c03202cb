#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/extensions.glsl"
// Ground under a town: worn grass and bare earth, into the haze that the sky begins with.
#include "shaders/roof/draw_records.h"
#include "shaders/roof/look.glsl"

layout(push_constant, scalar) uniform Data { RoofGroundPush push; };
layout(location = 0) in vec3 position;
layout(location = 0) out vec4 color;

// Noise with features of `metres`, faded out where a pixel holds more than one of them.
float patches(float metres, float pixel) {
    return (noise3(vec3(position.xz / metres, 0.5)) - 0.5) * clamp(2.0 - 3.0 * pixel / metres, 0.0, 1.0);
}

void main() {
    const vec3 up = vec3(0.0, 1.0, 0.0);
    if (push.frame.v[0].view != kViewShaded) {
        color = push.frame.v[0].view == kViewNormals ? stored(up * 0.5 + 0.5, 0.0) : diagnostic(push.frame, vec3(0.4), up);
        return;
    }
    float pixel = sqrt(max(length(dFdx(position.xz)) * length(dFdy(position.xz)), 1e-8));
    float coarse = patches(31.0, pixel) + 0.6 * patches(9.0, pixel);
    float fine = patches(1.7, pixel) + 0.8 * patches(0.31, pixel) + 0.9 * patches(0.06, pixel) + 0.7 * patches(0.018, pixel);
    // Where it is trodden, earth shows.
    float bare = smoothstep(0.2, 0.34, coarse + 0.3 * fine);
    vec3 base = mix(push.colour, push.colour.yyy * vec3(1.35, 1.1, 0.8), bare) * max(1.0 + 0.8 * fine + 0.3 * coarse, 0.2);
    vec4 near = shade(push.frame, base, up, position, 1.0);
    float away = distance(push.frame.v[0].eye, position);
    vec3 ray = (position - push.frame.v[0].eye) / away;
    float glow = max(dot(ray, push.frame.v[0].sunDirection), 0.0);
    vec3 haze = push.frame.v[0].horizon + push.frame.v[0].sunColor * 0.05 * pow(glow, 12.0);
    float share = away / push.reach;
    color = mix(near, stored(toneMapped(haze * push.frame.v[0].exposure), 0.0), 1.0 - exp(-share * share));
}
