#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/extensions.glsl"
// A far grid: its cells' colours and the shadows of their lower edges, fading into their mean as cells get small.
#include "shaders/roof/look.glsl"
#include "shaders/roof/place.glsl"

layout(push_constant, scalar) uniform Data { RoofDrawPush push; };
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec4 surface;
layout(location = 3) flat in uvec4 look;
layout(location = 0) out vec4 color;

void main() {
    vec3 n = normalize(normal);
    if (dot(n, push.frame.v[0].eye - position) < 0.0 && !gl_FrontFacing) n = -n;
    uint view = push.frame.v[0].view;
    if (view != kViewShaded) {
        color = view == kViewNormals ? stored(n * 0.5 + 0.5, 0.0) : diagnostic(push.frame, lodColor(5u), n);
        return;
    }
    vec2 cell = surface.xy;
    vec2 width = fwidth(cell);
    float row = floor(cell.y);
    float shift = look.z != 0u && (uint(row) & 1u) != 0u ? 0.5 : 0.0;
    float column = floor(cell.x + shift);
    float clear = clamp(1.5 - 1.5 * max(width.x, width.y), 0.0, 1.0);
    uint h = look.y ^ (uint(column) * 0x9E3779B1u) ^ (uint(row) * 0x85EBCA77u);
    h = (h ^ (h >> 15u)) * 0x2C1B3C6Du;
    h = (h ^ (h >> 12u)) * 0x297A2D39u;
    h ^= h >> 15u;
    float variation = mix(0.5, float(h & 255u) * (1.0 / 255.0), clear);
    vec3 base = weathered(unpackColour(look.x), variation, surface.w, position);
    // Each cell's lower edge shades the one below.
    float edge = 1.0 - smoothstep(0.0, max(0.12, width.y), 1.0 - fract(cell.y));
    base *= 1.0 - 0.35 * mix(0.12, edge, clear);
    color = shade(push.frame, base, n, position, push.roughness);
}
