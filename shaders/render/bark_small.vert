#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/extensions.glsl"
// Ribbons of bark, a few pixels wide: lit at each vertex.
#include "shaders/render/light.glsl"
#include "shaders/render/bark_color.glsl"
#include "shaders/render/bark_vertex.glsl"

layout(push_constant, scalar) uniform Data { TerminalPush push; };
layout(location = 0) out vec4 uvFade;      // uv; fade; share of the light that is the sky's
layout(location = 1) out vec3 own;         // light on a texel's colour,
layout(location = 2) out vec3 other;       // and what needs none
layout(location = 3) flat out uint hash;

void main() {
    BarkVertex v = barkVertex(push, uint(gl_VertexIndex), uint(gl_InstanceIndex));
    vec3 n = normalize(v.normal);
    vec3 eye = normalize(frame.eye - v.position);
    vec3 sun = frame.sunDirection;
    float facing = max(dot(n, sun), 0.0);
    vec3 falling = frame.sunColor * (facing * facingSunVisibility(facing, v.position, n));
    vec3 ambient = skyLight(n) * 0.8;
    float young = youngBark(log2(max(v.radius, 1e-9)));
    vec3 all = (falling + ambient) * frame.exposure;
    own = push.baseColor.rgb * (1.0 - young) * all;
    other = kYoungBark * young * all + falling * gloss(n, eye, sun, max(push.roughness, 0.5)) * frame.exposure;
    // One turn around is 2 pi r; a power of two near that of the span's thicker end.
    float octave = floor(log2(max(max(v.span.radius0, v.span.radius1), 1e-9)));
    const vec3 weights = vec3(0.3, 0.6, 0.1);
    float share = dot(ambient, weights) / max(dot(falling + ambient, weights), 1e-5);
    uvFade = vec4(v.around, v.metres * exp2(-octave) * (1.0 / 6.2831853), barkFade(v.span), share);
    hash = barkHash(v.span);
    gl_Position = frame.viewProjection * vec4(v.position, 1.0);
}
