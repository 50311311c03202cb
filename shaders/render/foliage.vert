#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/extensions.glsl"
// Leaves of trees and bushes on cards, and blades of grass: lit at each vertex. A card's normals point out of its crown, so
// that the crown has one light and one dark side; the whole part of its texture u is how deep in the crown it lies, in
// eighths, 8 being outside.
#include "shaders/render/light.glsl"
#include "shaders/render/prop_vertex.glsl"

layout(push_constant, scalar) uniform Data { PropPush push; };
layout(location = 0) out vec3 uvShare;   // uv; share of the light that is the sky's
layout(location = 1) out vec3 light;     // on a texel's colour
layout(location = 2) flat out float fade;

vec3 foliageColor(PropVertex v) {
    vec3 young = vec3(1.16, 1.06, 0.72), old = vec3(0.80, 0.92, 0.92);
    return push.baseColor.rgb * mix(old, young, v.tint);
}
// As meadow.glsl: green, in places dry; u is how far up the blade.
vec3 grassColor(PropVertex v) {
    vec3 green = frame.grassColor * (0.30 + 1.25 * v.uv.x);
    vec3 dry = frame.grassColor.yyy * vec3(1.25, 1.15, 0.48) * (0.45 + 1.05 * v.uv.x);
    return mix(green, dry, 0.65 * v.tint);
}

void main() {
    PropVertex v = propVertex(uint(gl_VertexIndex), push.firstInstance + uint(gl_InstanceIndex));
    bool grass = push.grass != 0u;
    float open = grass ? 0.45 + 0.55 * v.uv.x : floor(v.uv.x) * 0.125;
    float side = dot(v.normal, frame.sunDirection);
    // Light gets some way into a crown.
    float into = grass ? 0.0 : 0.9 * frame.unit;
    float visible = mix(grass ? 0.0 : 0.22, 1.0, sunVisibility(v.position + frame.sunDirection * into, v.normal));
    // Leaves turn every way: what falls on a crown's far side comes through, the more the thinner it is.
    float facing = clamp(0.34 + 0.66 * side, 0.14, 1.0);
    vec3 tone = grass ? grassColor(v) : foliageColor(v);
    vec3 direct = frame.sunColor * (visible * facing * (0.45 + 0.55 * open));
    vec3 ambient = skyLight(v.normal) * open * (0.50 + 0.50 * open);
    const vec3 weights = vec3(0.3, 0.6, 0.1);
    light = tone * (direct + ambient) * frame.exposure;
    uvShare = vec3(v.uv, dot(ambient, weights) / max(dot(direct + ambient, weights), 1e-5));
    fade = v.fade;
    gl_Position = frame.viewProjection * vec4(v.position, 1.0);
}
