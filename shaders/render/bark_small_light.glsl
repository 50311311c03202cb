// The light on bark of few pixels, found at its vertices or before them.
#ifndef ESPALIER_RENDER_BARK_SMALL_LIGHT_GLSL
#define ESPALIER_RENDER_BARK_SMALL_LIGHT_GLSL
#include "shaders/render/light.glsl"
#include "shaders/render/bark_color.glsl"

// Of a texel's colour c, c * own + other is the bark's.
struct SmallBark {
    vec3 own, other;
    float share;   // of the light that is the sky's
};

// n: unit.
SmallBark smallBark(TerminalPush push, vec3 position, vec3 n, float radius) {
    vec3 eye = normalize(frame.eye - position);
    vec3 sun = frame.sunDirection;
    float facing = max(dot(n, sun), 0.0);
    vec3 falling = frame.sunColor * (facing * facingSunVisibility(facing, position, n));
    vec3 ambient = skyLight(n) * 0.8;
    float young = youngBark(log2(max(radius, 1e-9)));
    vec3 all = (falling + ambient) * frame.exposure;
    SmallBark o;
    o.own = push.baseColor.rgb * (1.0 - young) * all;
    o.other = kYoungBark * young * all + falling * gloss(n, eye, sun, max(push.roughness, 0.5)) * frame.exposure;
    const vec3 weights = vec3(0.3, 0.6, 0.1);
    o.share = dot(ambient, weights) / max(dot(falling + ambient, weights), 1e-5);
    return o;
}

// Texture coordinates along the branch, a metre. One turn around is 2 pi r; a power of two near that of the span's
// thicker end.
float smallBarkScale(float radius0, float radius1) {
    return exp2(-floor(log2(max(max(radius0, radius1), 1e-9)))) * (1.0 / 6.2831853);
}
#endif
