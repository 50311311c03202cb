#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/extensions.glsl"
// A far grid: its cells' colours, their profile across and the shadows of their lower edges, fading into their mean as
// cells get small.
#include "shaders/render/roof_look.glsl"
#include "shaders/render/roof_place.glsl"

layout(push_constant, scalar) uniform Data { RoofDrawPush push; };
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec4 surface;
layout(location = 3) flat in uvec4 look;
layout(location = 4) flat in vec3 lean;
layout(location = 0) out vec4 color;

const float kEdge = 0.12;   // of a cell

RoofProfile profileAt(RoofDrawEnv env, float x) {
    uint step = uint(fract(x) * float(kProfileSteps)) & (kProfileSteps - 1u);
    return env.profiles.v[(look.w & 255u) * kProfileSteps + step];
}
RoofLight lightOnSides(vec3 n, float left, float right) {
    RoofLight a = lightOn(normalize(n + lean * left)), b = lightOn(normalize(n + lean * right));
    return RoofLight(0.5 * (a.facing + b.facing), 0.5 * (a.sky + b.sky));
}

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
    RoofDrawEnv env = push.env.v[0];
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
    float edge = (1.0 - smoothstep(0.0, max(kEdge, width.y), 1.0 - fract(cell.y))) * min(kEdge / width.y, 1.0);
    edge = mix(0.5 * kEdge, edge, clear);
    base *= 1.0 - kDarkOfEdges * edge;
    // Ribs are lit on both of their sides at once where they are too small to be told apart.
    RoofProfile left = profileAt(env, cell.x + shift - 0.25 * width.x), right = profileAt(env, cell.x + shift + 0.25 * width.x);
    float ribs = clamp(2.2 - 6.0 * width.x, 0.0, 1.0);
    RoofLight told = lightOnSides(n, left.slope, right.slope), light = lightOnSides(n, -left.steepness, left.steepness);
    light = RoofLight(mix(light.facing, told.facing, ribs), mix(light.sky, told.sky, ribs));
    if (surface.z > 0.5)   // battens: wood, and the dark between
        base *= mix(left.meanShade, abs(fract(cell.y) - 0.2) < 0.1 ? 1.0 : 0.12, clear);
    else
        base *= mix(left.meanShade, 0.5 * (left.shade + right.shade), ribs);
    base = mossy(env, look.w, base, position, edge);
    uint drop = (look.w >> kGridDrop) & 15u;
    if (drop != 0u) {
        float painted = roofLayerAt(env.roofs.layers, env.roofs.site, drop - 1u, position.xz);
        float gone = painted > cellHold(u64(look.y), uint(int(column)), uint(int(row))) ? 1.0 : 0.0;
        base = mix(base, vec3(0.016, 0.013, 0.01), mix(painted, gone, clear) * step(0.001, painted));
    }
    color = shade(base, n, light, position, push.roughness, vec3(0.0));
    if (layerOver()) color = mix(color, otherView(env, shown, n, position), frame.layerOpacity);
}
