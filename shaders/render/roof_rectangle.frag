#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/extensions.glsl"
// A far grid: its cells' colours and the shadows of their lower edges, fading into their mean as cells get small.
#include "shaders/render/roof_look.glsl"
#include "shaders/render/roof_place.glsl"

layout(push_constant, scalar) uniform Data { RoofDrawPush push; };
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec4 surface;
layout(location = 3) flat in uvec4 look;
layout(location = 0) out vec4 color;

void main() {
    vec3 n = normalize(normal);   // from below one sees what stands up from it, ridges' caps, not its underside
    uint view = frame.view;
    if (explains && view == kViewOverdraw) {
        color = oneFragment();
        return;
    }
    vec3 shown = view == kViewLod ? lodColor(5u) : vec3(0.5);
    if (explains && !layerOver()) {
        color = otherView(push.env.v[0], shown, n, position);
        return;
    }
    vec2 cell = surface.xy;
    vec2 width = fwidth(cell);
    float row = floor(cell.y);
    float shift = look.z != 0u && (uint(int(row)) & 1u) != 0u ? 0.5 : 0.0;
    float column = floor(cell.x + shift);
    float clear = clamp(1.5 - 1.5 * max(width.x, width.y), 0.0, 1.0);
    uint h = roofCellHash(u64(look.y), uint(int(column)), uint(int(row)));
    float variation = mix(0.5, float(h & 255u) * (1.0 / 255.0), clear);
    vec3 base = weathered(unpackColour(look.x), variation, surface.w, position);
    // Each cell's lower edge shades the one below.
    float edge = 1.0 - smoothstep(0.0, max(0.12, width.y), 1.0 - fract(cell.y));
    base *= 1.0 - 0.35 * mix(0.12, edge, clear);
    // Battens: wood, and the dark between.
    if (surface.z > 0.5) base *= mix(kShadeOfBattens, abs(fract(cell.y) - 0.2) < 0.1 ? 1.0 : 0.12, clear);
    RoofDrawEnv env = push.env.v[0];
    base = mossy(env, look.w, base, position, edge * clear);
    uint drop = (look.w >> kGridDrop) & 15u;
    if (drop != 0u) {
        float painted = roofLayerAt(env.roofs.layers, env.roofs.site, drop - 1u, position.xz);
        float gone = painted > cellHold(u64(look.y), uint(int(column)), uint(int(row))) ? 1.0 : 0.0;
        base = mix(base, vec3(0.016, 0.013, 0.01), mix(painted, gone, clear) * step(0.001, painted));
    }
    color = shade(base, n, position, push.roughness, vec3(0.0));
    if (layerOver()) color = mix(color, otherView(env, shown, n, position), frame.layerOpacity);
}
