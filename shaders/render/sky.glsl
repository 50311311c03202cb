// The sky's colours, which haze takes on too.
#ifndef ESPALIER_RENDER_SKY_GLSL
#define ESPALIER_RENDER_SKY_GLSL
#include "shaders/render/frame_records.h"

// ray: unit.
vec3 skyColor(FrameBuf frame, vec3 ray) {
    vec3 sky = mix(frame.v[0].horizon, frame.v[0].background, sqrt(clamp(ray.y * 1.1, 0.0, 1.0)));
    vec3 below = mix(frame.v[0].horizon, frame.v[0].groundColor * 1.2, clamp(-ray.y * 3.0, 0.0, 1.0));
    float glow = max(dot(ray, frame.v[0].sunDirection), 0.0);
    return (ray.y > 0.0 ? sky : below) + frame.v[0].sunColor * 0.05 * pow(glow, 12.0);
}

// Wooded land so far away that it is mostly haze, in ranges 0, 1, 2 ... behind each other.
vec3 farLand(FrameBuf frame, vec3 ray, float range) {
    vec3 haze = skyColor(frame, normalize(vec3(ray.x, 0.0, ray.z)));
    return mix(frame.v[0].skyColor * vec3(0.11, 0.14, 0.07), haze, 0.52 + 0.15 * range);
}
#endif
