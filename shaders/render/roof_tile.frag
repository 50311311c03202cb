#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/extensions.glsl"
// Cells drawn as meshes.
#include "shaders/render/roof_draw_records.h"
#include "shaders/render/roof_look.glsl"

layout(push_constant, scalar) uniform Data { RoofDrawPush push; };
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec4 surface;
layout(location = 3) flat in uvec4 look;
layout(location = 0) out vec4 color;

void main() {
    vec3 n = normalize(normal);
    if (dot(n, frame.eye - position) < 0.0 && !gl_FrontFacing) n = -n;
    uint view = frame.view;
    if (explains && view == kViewOverdraw) {
        color = oneFragment();
        return;
    }
    vec3 shown = view == kViewLod ? lodColor(look.z) : vec3(0.5);
    if (explains && !layerOver()) {
        color = otherView(push.env.v[0], shown, n, position);
        return;
    }
    float variation = float(look.y & 255u) * (1.0 / 255.0);
    vec3 base = weathered(unpackColour(look.x) * surface.z, variation, max(surface.w, 0.0), position);
    base = mossy(push.env.v[0], look.w, base, position, clamp(1.0 - surface.z, 0.0, 1.0));
    vec3 from = vec3(0.0);
    if (surface.w < 0.0) from = mirrored(n, position) + lamplight(float((look.y >> 8u) & 255u) * (1.0 / 255.0));
    color = shade(base, n, lightOn(n), position, push.roughness, from);
    if (layerOver()) color = mix(color, otherView(push.env.v[0], shown, n, position), frame.layerOpacity);
}
