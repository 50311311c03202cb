#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/extensions.glsl"
// Cells drawn as meshes.
#include "shaders/render/roof_draw_records.h"
#include "shaders/render/roof_look.glsl"

layout(push_constant, scalar) uniform Data { RoofDrawPush push; };
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec3 surface;
layout(location = 3) flat in uvec4 look;
layout(location = 0) out vec4 color;

const vec3 kBehindBars = vec3(0.028, 0.033, 0.039);   // what is seen of a room

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
    vec3 base = weathered(unpackColour(look.x) * surface.y, variation, max(surface.z, 0.0), position);
    base = mossy(push.env.v[0], look.w, base, position, clamp(1.0 - surface.y, 0.0, 1.0));
    vec3 from = vec3(0.0);
    if (surface.z < 0.0) from = mirrored(n, position) + lamplight(float((look.y >> 8u) & 255u) * (1.0 / 255.0));
    if (surface.x < 1.0) {   // a bar, and the pane beside it
        base = mix(kBehindBars, base, surface.x);
        from = mirrored(n, position) * (1.0 - surface.x);
    }
    color = shade(base, n, lightOn(n), position, push.roughness, from);
    if (layerOver()) color = mix(color, otherView(push.env.v[0], shown, n, position), frame.layerOpacity);
}
