// A meadow's colour and bumps: grass in patches of hue, worn earth here and there, blades near by, and what the site's map
// lays over it: paved streets between kerbs, trodden earth. What stands on the ground goes over into it.
#ifndef ESPALIER_RENDER_MEADOW_GLSL
#define ESPALIER_RENDER_MEADOW_GLSL
#include "shaders/render/frame.glsl"
#include "shaders/render/meadow_hue.h"

struct Meadow {
    vec3 base, normal;
    float open;   // share of the sky that is seen
};

const float kSiteReach = 1.0;   // metres inside a street where the site's red is 1; as far outside it is 0

// Setts and joints up to a kerb. inside: metres from its outer edge; pixel: how much that changes over a pixel; far: 1 where
// kerbs aren't told apart.
void addStreet(sampler2D paving, vec2 place, vec2 dx, vec2 dy, float inside, float pixel, float far, float uneven, inout Meadow m) {
    const float side = 1.0 / 2.4;
    vec4 stone = textureGrad(paving, place * side, dx * side, dy * side);
    float worn = 0.80 + 0.35 * uneven;
    vec3 setts = mix(vec3(0.062, 0.054, 0.040), vec3(0.200, 0.182, 0.155) * worn, stone.g) * (0.55 + 0.75 * stone.r);
    vec3 kerb = vec3(0.225, 0.208, 0.178) * (0.72 + 0.45 * stone.r) * worn;
    float wide = pixel + 0.012;
    float onKerb = clamp((0.26 - inside) / wide + 0.5, 0.0, 1.0) * (1.0 - far);
    float gutter = (1.0 - smoothstep(0.28, 0.55, inside)) * (1.0 - onKerb);
    vec3 base = mix(setts * (1.0 - 0.42 * gutter), kerb, onKerb);
    vec2 slope = (stone.ba * 2.0 - 1.0) * (1.0 - 0.7 * onKerb);
    float share = clamp(inside / wide + 0.5, 0.0, 1.0);
    m.base = mix(m.base, base, share);
    m.normal = mix(m.normal, normalize(vec3(-slope.x, 1.0, -slope.y)), share);
}

// What the site's map says of a place. x: metres into a street, negative beside it; y: trodden earth; z: share of the sky
// that is seen.
vec3 siteAt(sampler2D site, vec2 place, vec2 dx, vec2 dy) {
    vec3 laid = vec3(0.0, 0.0, 1.0);
    if (frame.siteRcp.x > 0.0)
        laid = textureGrad(site, (place - frame.siteLow) * frame.siteRcp, dx * frame.siteRcp, dy * frame.siteRcp).xyz;
    return vec3((laid.x - 0.5) * (2.0 * kSiteReach), laid.yz);
}

// noise, paving: as Ground binds them. place: on the ground, metres; dx, dy: its change from pixel to pixel;
// metres: from the eye; laid: siteAt(); pixel: change of laid.x from pixel to pixel; fields: far off lie
// fields and woods.
Meadow meadowAt(sampler2D noise, sampler2D paving, vec2 place, vec2 dx, vec2 dy, float metres, vec3 laid, float pixel, bool fields) {
    // Near by a small tile says what differs within some metres; farther off its place is taken by a large one, turned
    // against the tile that says what differs over tens of metres: seen many times over, that alone would be a pattern.
    const mat2 small = mat2(0.8, 0.6, -0.6, 0.8) * (1.0 / 5.3), large = mat2(0.921, 0.389, -0.389, 0.921) * (1.0 / 409.0);
    bool close = metres < 50.0;
    mat2 second = close ? small : large;
    const mat2 mown = mat2(0.6, -0.8, 0.8, 0.6) * (1.0 / 1.3);
    vec4 broad = textureGrad(noise, place * (1.0 / kMeadowTile), dx * (1.0 / kMeadowTile), dy * (1.0 / kMeadowTile)) * 2.0 - 1.0;
    vec4 other = textureGrad(noise, second * place, second * dx, second * dy) * 2.0 - 1.0;
    vec4 near = other * (close ? 1.0 - smoothstep(30.0, 50.0, metres) : 0.0);
    vec4 wide = other * (close ? 0.0 : smoothstep(50.0, 130.0, metres));
    // Blades are told apart near by only, and seen too flatly for their mean to do.
    vec4 fine = vec4(0.0);
    float share = clamp(1.5 - metres * 0.03, 0.0, 1.0);
    if (share > 0.0)
        fine = (textureGrad(noise, mown * place, mown * dx * 0.5, mown * dy * 0.5) * 2.0 - 1.0) * share;

    // Patches that lie flat to the eye run together into streaks: far away the meadow is one green, its hue changing slowly,
    // and what differs within some metres, as slopes do, is lost first.
    float calm = clamp(metres * 0.04 - 0.24, 0.0, 1.0);
    broad *= 1.0 - vec4(0.40, 0.0, 0.85, 0.85) * calm;
    float tiled = smoothstep(50.0, 130.0, metres);
    broad *= 1.0 - vec4(0.55, 0.0, 0.5, 0.5) * tiled;
    broad += vec4(0.42 * wide.x, 0.0, 0.30 * wide.z, 0.22 * wide.w - 0.15 * wide.x);
    broad *= 1.0 - 0.5 * smoothstep(250.0, 1500.0, metres);
    float grass = smoothstep(-0.30, 0.25, 0.38 + 0.5 * calm + (0.7 * broad.x + 0.8 * near.x) * (1.0 - 0.7 * calm) + 0.75 * fine.y - 1.5 * laid.y);
    float blades = clamp(0.5 + 0.75 * fine.y + 0.2 * near.x * (1.0 - calm), 0.0, 1.0);
    // Here thicker, there thinner, in swathes of some metres.
    vec3 green = frame.grassColor * ((0.35 + blades) * broadGrowth(broad));
    float dry = clamp(kMeadowDry + (broadDryness(broad) + 0.45 * near.z) * (1.0 - 0.35 * calm) + 0.25 * fine.y, 0.0, kMeadowMostDry);
    green = mix(green, frame.grassColor.yyy * vec3(1.25, 1.15, 0.48) * (0.55 + 0.75 * blades), dry);
    // Clover and sorrel, and swathes that were cut earlier, over tens of metres.
    float swathe = clamp(broadSwathe(broad) + 0.45 * near.y * (1.0 - calm), 0.0, 1.0);
    green *= swatheTint(swathe);
    vec3 earth = mix(vec3(0.068, 0.056, 0.036), vec3(0.146, 0.122, 0.082), 0.5 + 0.5 * fine.x + 0.2 * near.z) * (1.0 + 0.55 * fine.y);   // and straw on it
    // Far off lie fields, and woods between them: they lie in strips behind each other. From above they would be blotches.
    float far = clamp(metres * 0.012 - 0.9, 0.0, 1.0);
    float aslant = 1.0 - smoothstep(0.12, 0.40, (frame.eye.y - frame.groundLevel) / (frame.unit * max(metres, 1.0)));
    if (fields && far * aslant > 0.0) {
        vec4 land = textureGrad(noise, place * (1.0 / 730.0), dx * (1.0 / 730.0), dy * (1.0 / 730.0)) * 2.0 - 1.0;
        land = 0.6 * land + 0.55 * wide.zwxy;   // no wood is there twice
        green = mix(green, green.yyy * vec3(1.25, 1.12, 0.55), far * aslant * smoothstep(0.05, 0.35, land.z));
        green *= 1.0 - 0.42 * far * aslant * smoothstep(0.0, 0.22, land.x + 0.5 * broad.x);
    }
    Meadow m;
    m.base = mix(earth, green, grass);
    vec2 slope = near.zw * 0.35 * (1.0 - calm) + fine.zw * 0.55;
    m.normal = normalize(vec3(-slope.x, 1.0, -slope.y));
    m.open = laid.z;
    if (laid.x > -0.3) addStreet(paving, place, dx, dy, laid.x, pixel, far, near.x, m);
    return m;
}
#endif
