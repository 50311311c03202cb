// What materials mirror: the sun as a disc that roughness blurs (GGX), and the sky and the ground around, which no image
// holds but functions. Split as Karis 2013 does: what comes from around, times how much of it a microfacet throws back.
#ifndef ESPALIER_RENDER_MIRROR_GLSL
#define ESPALIER_RENDER_MIRROR_GLSL
#include "shaders/render/light.glsl"
#include "shaders/render/sky.glsl"

const float kLeastRough = 0.12;   // of the sun's image: what is sharper would be a glitter of single pixels

struct Mirror {
    vec3 straight;   // share of the light from straight ahead that is thrown back
    float rough;     // 0 to 1
};

// A dielectric throws back 4 % in white, a metal its colour.
Mirror mirrorOf(vec3 base, float metallic, float rough) {
    return Mirror(mix(vec3(0.04), base, metallic), clamp(rough, 0.0, 1.0));
}

float fifth(float c) { return (c * c) * (c * c) * c; }

// Of the sun's light that falls straight on it; times the cosine of how it falls.
vec3 mirroredSun(Mirror m, vec3 n, vec3 eye, vec3 sun) {
    float a = max(m.rough, kLeastRough);
    a *= a;
    vec3 h = normalize(eye + sun);
    float facing = max(dot(n, sun), 0.0), seen = max(dot(n, eye), 1e-3), nh = max(dot(n, h), 0.0);
    float spread = nh * nh * (a * a - 1.0) + 1.0;
    float gaps = 0.5 / max(mix(2.0 * facing * seen, facing + seen, a), 1e-4);
    vec3 thrown = m.straight + (1.0 - m.straight) * fifth(1.0 - clamp(dot(eye, h), 0.0, 1.0));
    return thrown * (facing * a * a * gaps / (spread * spread));   // pi: sunColor is what a white wall shows
}

// From around it. Rough ones see the mean of half the sky, smooth ones one place of it.
vec3 mirroredSky(Mirror m, vec3 n, vec3 eye) {
    vec3 ray = reflect(-eye, n);
    float blur = m.rough * (2.0 - m.rough);
    vec3 around = mix(skyColor(ray), skyLight(normalize(mix(ray, n, m.rough * m.rough))), blur);
    // Lazarov's fit of the integral over a hemisphere.
    vec4 r = m.rough * vec4(-1.0, -0.0275, -0.572, 0.022) + vec4(1.0, 0.0425, 1.04, -0.04);
    float edge = min(r.x * r.x, exp2(-9.28 * max(dot(n, eye), 0.0))) * r.x + r.y;
    return around * (m.straight * (-1.04 * edge + r.z) + vec3(1.04 * edge + r.w));
}
#endif
