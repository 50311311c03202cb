// Sun with shadow, sky, ground; the same for all that is drawn.
#ifndef ESPALIER_RENDER_LIGHT_GLSL
#define ESPALIER_RENDER_LIGHT_GLSL
#include "shaders/render/tone.glsl"
#include "shaders/render/fade.glsl"
#include "shaders/render/heat.h"

layout(set = 0, binding = 2) uniform sampler2DShadow shadowMap;

// 1: lit. The left half of the map is near and fine, the right half holds all that stands. Four bilinear comparisons in a
// ring of one and a half texels, which pictures that are averaged turn and widen differently, two in moving pictures: one
// leaves dark specks between leaves. Taken by all pixels: measured, a jump over them costs a software device more.
float sunVisibility(vec3 position, vec3 normal) {
    vec4 at = frame.shadowMatrix * vec4(position + normal * frame.shadowOffset, 1.0);
    vec2 off = abs(at.xy - 0.5);
    bool near = max(off.x, off.y) < 0.499;
    at.xyz = near ? at.xyz : at.xyz * frame.wideScale + frame.wideOffset;
    off = abs(at.xy - 0.5);
    bool covered = frame.shadows != 0u && max(off.x, off.y) < 0.499;
    at.x = 0.5 * at.x + (near ? 0.0 : 0.5);
    at.z = min(at.z, 0.9999);   // behind all that casts shadows
    vec2 d = vec2(0.375, 0.75) * frame.shadowTexel;
    vec2 tap = frame.shadowTap;
    float visible;
    if (quick)
        visible = 0.5 * (textureLod(shadowMap, vec3(at.xy + d * vec2(-0.9, -0.45), at.z), 0.0) +
                         textureLod(shadowMap, vec3(at.xy + d * vec2(0.9, 0.45), at.z), 0.0));
    else
        visible = 0.25 * (textureLod(shadowMap, vec3(at.xy - d * tap, at.z), 0.0) +
                          textureLod(shadowMap, vec3(at.xy + d * vec2(tap.y, -tap.x), at.z), 0.0) +
                          textureLod(shadowMap, vec3(at.xy + d * tap, at.z), 0.0) +
                          textureLod(shadowMap, vec3(at.xy + d * vec2(-tap.y, tap.x), at.z), 0.0));
    return covered ? visible : 1.0;
}

// 0 where the sun is behind.
float facingSunVisibility(float facing, vec3 position, vec3 normal) {
    float visible = sunVisibility(position, normal);
    return facing > 0.0 ? visible : 0.0;
}

// Light from the sky above and, bounced, from the ground below. The sky is brighter towards the sun; what faces away from
// it sees the lit sides of other things.
vec3 skyLight(vec3 normal) {
    float up = normal.y * 0.5 + 0.5, side = dot(normal.xz, frame.sunDirection.xz);
    vec3 above = frame.skyColor * (1.0 + 0.24 * side);
    vec3 below = frame.groundColor * ((1.0 - 0.45 * side) * (1.0 + 0.6 * max(-normal.y, 0.0)));
    return mix(below, above, up * up * (3.0 - 2.0 * up));
}

// Sheen of a rough dielectric: Blinn's lobe, Schlick's edge.
float gloss(vec3 normal, vec3 view, vec3 light, float roughness) {
    vec3 h = normalize(view + light);
    float a = roughness * roughness;
    float power = max(2.0 / max(a * a, 1e-3) - 2.0, 0.0);
    float c = 1.0 - clamp(dot(view, h), 0.0, 1.0);
    float edge = 0.04 + 0.96 * (c * c) * (c * c) * c;
    return edge * (power + 8.0) * 0.04 * pow(max(dot(normal, h), 1e-6), power);   // a power of 0 isn't defined
}

vec4 lit(vec3 direct, vec3 ambient) {
    const vec3 weights = vec3(0.3, 0.6, 0.1);
    float share = dot(ambient, weights) / max(dot(direct + ambient, weights), 1e-5);
    return sceneColor((direct + ambient) * frame.exposure, clamp(share, 0.0, 1.0));
}

vec4 diagnostic(vec3 color, vec3 normal) {
    return stored(color * (0.55 + 0.45 * max(dot(normal, frame.sunDirection), 0.0)), 0.6);
}

vec3 depthColor(uint depth) { return heatColor(float(depth) * (1.0 / kHottestDepth)); }

// Coverage of `alpha` over four samples, of a host's eight over either half. which: varies the pattern between things that lie over each other.
int coverage(float alpha, uint which) {
    uint n = uint(clamp(alpha, 0.0, 1.0) * 4.0 + 0.5);
    uint bits = (1u << n) - 1u;
    uint turn = which & 3u;
    return int((((bits << turn) | (bits >> (4u - turn))) & 15u) * 17u);
}
#endif
