#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/extensions.glsl"
// Leaves of few pixels: lit at each vertex.
#include "shaders/render/leaf_light.glsl"
#include "shaders/render/leaf_vertex.glsl"

layout(push_constant, scalar) uniform Data { TerminalPush push; };
layout(location = 0) out vec3 uvShare;   // uv; share of the light that is the sky's
layout(location = 1) out vec3 own;       // light on a texel's colour,
layout(location = 2) out vec3 turned;    // on its brightness,
layout(location = 3) out vec3 mirrored;  // and what needs no colour
layout(location = 4) flat out uint hash;

void main() {
    LeafVertex v = leafVertex(push, uint(gl_VertexIndex), uint(gl_InstanceIndex));
    bool leaf = ((v.instance.bits >> 8u) & 255u) == 1u;
    vec3 eye = normalize(frame.eye - v.position);
    bool back = dot(v.normal, eye) < 0.0;
    vec3 face = back ? -v.normal : v.normal;
    float visible = sunVisibility(v.position, dot(face, frame.sunDirection) > 0.0 ? face : -face);
    LeafLight light = leafLight(face, eye, v.open, visible, leaf, back);
    LeafTint tint = leafTint(push.baseColor.rgb, v.instance.tint, v.instance.hash, v.patchTone);
    vec3 all = (light.sun + light.sky) * frame.exposure;
    own = tint.own * all;
    turned = tint.turned * all;
    mirrored = (light.sunMirror + light.skyMirror) * frame.exposure;
    // The atlas holds the upper sides in its upper half, their paler backs below.
    float share = dot(light.sky, kLeafWeights) / max(dot(light.sun + light.sky, kLeafWeights), 1e-5);
    uvShare = vec3(v.uv + vec2(0.0, leaf && back ? 0.5 : 0.0), share);
    hash = v.instance.hash;
    gl_Position = frame.viewProjection * vec4(v.position, 1.0);
}
