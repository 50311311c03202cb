// How a roof's material looks: the grammar's colour, varied from tile to tile and weathered in patches.
#ifndef ESPALIER_ROOF_LOOK_GLSL
#define ESPALIER_ROOF_LOOK_GLSL
#include "shaders/render/light.glsl"

vec3 unpackColour(uint c) {
    vec3 root = vec3(c & 255u, (c >> 8u) & 255u, (c >> 16u) & 255u) * (1.0 / 255.0);
    return root * root;
}
float hash3(ivec3 p) {
    uint h = uint(p.x) * 0x9E3779B1u ^ uint(p.y) * 0x85EBCA77u ^ uint(p.z) * 0xC2B2AE3Du;
    h = (h ^ (h >> 15u)) * 0x2C1B3C6Du;
    return float((h ^ (h >> 13u)) & 0xFFFFu) * (1.0 / 65535.0);
}
float noise3(vec3 p) {
    ivec3 i = ivec3(floor(p));
    vec3 f = p - vec3(i);
    f = f * f * (3.0 - 2.0 * f);
    vec4 a = vec4(hash3(i), hash3(i + ivec3(1, 0, 0)), hash3(i + ivec3(0, 1, 0)), hash3(i + ivec3(1, 1, 0)));
    vec4 b = vec4(hash3(i + ivec3(0, 0, 1)), hash3(i + ivec3(1, 0, 1)), hash3(i + ivec3(0, 1, 1)), hash3(i + ivec3(1, 1, 1)));
    vec4 c = mix(a, b, f.z);
    vec2 d = mix(c.xz, c.yw, f.x);
    return mix(d.x, d.y, f.y);
}
// variation: 0..1 of the cell.
vec3 weathered(vec3 base, float variation, float tint, vec3 position) {
    float patchy = noise3(position * 0.7) * 0.6 + noise3(position * 2.9) * 0.4;
    base *= 1.0 + tint * 0.55 * (variation - 0.5) * 2.0;
    return base * (0.86 + 0.28 * patchy);
}
vec4 shade(FrameBuf frame, vec3 base, vec3 n, vec3 position, float roughness) {
    vec3 eye = normalize(frame.v[0].eye - position);
    vec3 sun = frame.v[0].sunDirection;
    float facing = max(dot(n, sun), 0.0);
    float visible = facing > 0.0 ? sunVisibility(frame, position, n) : 0.0;
    vec3 direct = frame.v[0].sunColor * visible * facing * (base + gloss(n, eye, sun, max(roughness, 0.35)));
    return lit(frame, direct, base * skyLight(frame, n));
}
#endif
