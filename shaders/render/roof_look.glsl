// How a roof's material looks: the grammar's colour, varied from tile to tile and weathered in patches.
#ifndef ESPALIER_ROOF_LOOK_GLSL
#define ESPALIER_ROOF_LOOK_GLSL
#include "shaders/render/light.glsl"
#include "shaders/render/sky.glsl"
#include "shaders/render/roof_draw_records.h"
#include "shaders/shared/roof_layers.h"

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
// variation: 0..1 of the cell. What has no tint, walls above all, is streaked by rain and splashed above the ground.
vec3 weathered(vec3 base, float variation, float tint, vec3 position) {
    vec3 finer = tint > 0.0 ? vec3(2.9) : vec3(4.1, 0.45, 4.1);
    float patchy = noise3(position * 0.7) * 0.6 + (quick ? 0.2 : noise3(position * finer) * 0.4);
    base *= 1.0 + tint * 0.55 * (variation - 0.5) * 2.0;
    float high = (position.y - frame.groundLevel) / frame.unit;
    vec3 splashed = mix(vec3(0.62, 0.585, 0.51), vec3(1.0), clamp(0.9 * high + 1.6 * patchy - 0.75, 0.0, 1.0));
    // Plaster and stone have a grain, which is seen near by.
    float near = quick ? 0.0 : clamp(1.5 - 0.25 * length(frame.eye - position) / frame.unit, 0.0, 1.0) * step(tint, 0.0);
    float grain = 0.0;
    if (near > 0.0)
        grain = near * (0.16 * noise3(position * 85.0) + 0.10 * noise3(position * 31.0) + 0.08 * noise3(position * 9.0) - 0.17);
    return base * splashed * (0.84 + 0.32 * patchy + grain);
}
// Moss grows in cushions where its layer is painted, thickest in the joints and on the shaded side of tiles.
vec3 mossy(RoofDrawEnv env, uint mesh, vec3 base, vec3 position, float joint) {
    uint layer = (mesh >> kGridMoss) & 15u;
    if (layer == 0u) return base;
    float painted = roofLayerAt(env.roofs.layers, env.roofs.site, layer - 1u, position.xz);
    if (painted <= 0.0) return base;
    float cushions = noise3(position * 3.1) * 0.45 + (quick ? 0.275 : noise3(position * 9.7) * 0.35 + noise3(position * 31.0) * 0.2);
    float share = 1.0 - smoothstep(0.38, 0.62, cushions + 0.55 * (0.75 - painted) - 0.2 * joint);
    vec3 green = mix(vec3(0.038, 0.046, 0.016), vec3(0.085, 0.098, 0.03), quick ? 0.5 : noise3(position * 17.0));
    return mix(base, green * (1.0 - 0.4 * joint), share * min(1.0, 3.0 * painted));
}
float painted(RoofDrawEnv env, uint layer, vec3 position) {
    return roofLayerAt(env.roofs.layers, env.roofs.site, layer, position.xz);
}
// What other views than the shaded one show. shown: where that isn't a layer.
vec4 otherView(RoofDrawEnv env, vec3 shown, vec3 n, vec3 position) {
    if (frame.view == kViewNormals) return stored(n * 0.5 + 0.5, 0.0);
    if (frame.view == kViewLayer)
        shown = env.shownLayer == kNoIndex ? vec3(0.4) : isColourLayers(env.shownLayer) ?
                vec3(painted(env, env.shownLayer & 255u, position), painted(env, (env.shownLayer >> 8u) & 255u, position),
                     painted(env, (env.shownLayer >> 16u) & 255u, position)) :
                layerColor(painted(env, env.shownLayer, position));
    return diagnostic(shown, n);
}
// A painted layer that the shaded picture shows through.
bool layerOver() { return explains && frame.view == kViewLayer && frame.layerOpacity < 1.0; }
// What a pane mirrors: the sky and, below an uneven crest, what stands across the way. Old glass isn't quite flat.
vec3 mirrored(vec3 n, vec3 position) {
    vec3 eye = normalize(frame.eye - position);
    float c = 1.0 - clamp(dot(n, eye), 0.0, 1.0);
    vec3 ray = reflect(-eye, n);
    ray.y += 0.05 * (noise3(position * 2.3) - 0.5);
    float crest = 0.02 + 0.30 * noise3(vec3(5.0 * ray.xz, 0.5)) + 0.08 * noise3(vec3(21.0 * ray.xz, 7.5));
    vec3 across = mix(frame.groundColor * 0.30, frame.skyColor * vec3(0.13, 0.16, 0.10), clamp(8.0 * ray.y + 0.5, 0.0, 1.0));
    vec3 seen = mix(across, skyColor(ray), smoothstep(-0.03, 0.03, ray.y - crest));
    return seen * (0.18 + 0.82 * (c * c) * (c * c) * c);
}
// When it is dark, some rooms are lit. own: a number of the pane's, 0 to 1.
vec3 lamplight(float own) {
    const vec3 weights = vec3(0.3, 0.6, 0.1);
    float dark = 1.0 - smoothstep(0.06, 0.24, dot(frame.background, weights));
    dark *= 1.0 - smoothstep(0.6, 1.8, dot(frame.sunColor, weights));
    float lamp = own < 0.4 ? 0.45 + 1.4 * own : 0.0;
    return vec3(1.0, 0.60, 0.24) * (dark * lamp);
}
const float kClear = 150.0, kHazy = 400.0;   // metres
// What of the sun's and the sky's light a surface gets.
struct RoofLight {
    float facing;
    vec3 sky;
};
RoofLight lightOn(vec3 n) { return RoofLight(max(dot(n, frame.sunDirection), 0.0), skyLight(n)); }
// from: what is mirrored besides.
vec4 shade(vec3 base, vec3 n, RoofLight light, vec3 position, float roughness, vec3 from) {
    vec3 eye = normalize(frame.eye - position);
    float visible = facingSunVisibility(light.facing, position, n);
    vec3 direct = frame.sunColor * visible * light.facing * (base + gloss(n, eye, frame.sunDirection, max(roughness, 0.35)));
    vec3 ambient = base * light.sky + from;
    // A village stands in clear air, houses far off in the haze of the ground there.
    float away = distance(frame.eye, position) / frame.unit;
    if (away > kClear && frame.groundLevel != kNoGround) {
        float haze = hazeAt(away) * smoothstep(kClear, kHazy, away);
        direct *= 1.0 - haze;
        ambient = mix(ambient, farLand(-eye, 0.0), haze);
    }
    return lit(direct, ambient);
}
#endif
