// The sky's colours, which haze takes on too.
#ifndef ESPALIER_RENDER_SKY_GLSL
#define ESPALIER_RENDER_SKY_GLSL
#include "shaders/render/frame.glsl"

// ray: unit.
vec3 skyColor(vec3 ray) {
    vec3 sky = mix(frame.horizon, frame.background, sqrt(clamp(ray.y * 1.1, 0.0, 1.0)));
    vec3 below = mix(frame.horizon, frame.groundColor * 1.2, clamp(-ray.y * 3.0, 0.0, 1.0));
    float glow = max(dot(ray, frame.sunDirection), 0.0);
    glow *= glow;
    glow *= glow;
    return (ray.y > 0.0 ? sky : below) + frame.sunColor * (0.05 * glow * glow * glow);
}

// How much of what is so far away, near the ground, is haze. It lies low: from above one looks through less of it.
float hazeAt(float metres) {
    float rise = max((frame.eye.y - frame.groundLevel) / (40.0 * frame.unit), 1e-3);
    return 1.0 - exp(metres * (1.0 / 420.0) * (exp(-rise) - 1.0) / rise);
}
// Wooded land so far away that it is mostly haze, in ranges 0, 1, 2 ... behind each other; the more so the lower it lies,
// so that each range rises out of the mist over the one before. At the foot of the first there is little of it: the plain
// goes over into its woods.
vec3 farLand(vec3 ray, float range) {
    vec3 haze = skyColor(normalize(vec3(ray.x, 0.0, ray.z)));
    float mist = exp2(-max(ray.y, 0.0) * (110.0 - 25.0 * range)) * (range > 0.0 ? 0.28 - 0.04 * range : 0.10);
    return mix(frame.skyColor * vec3(0.11, 0.14, 0.07), haze, 0.25 + 0.17 * range + mist);
}
#endif
