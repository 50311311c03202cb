#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/extensions.glsl"
// Leaves of few pixels: lit at each vertex.
#include "shaders/render/leaf_small_light.glsl"

layout(push_constant, scalar) uniform Data { TerminalPush push; };
layout(location = 0) out vec3 uvShare;   // uv; share of the light that is the sky's
layout(location = 1) out vec3 own;       // light on a texel's colour,
layout(location = 2) out vec3 turned;    // on its brightness,
layout(location = 3) out vec3 mirrored;  // and what needs no colour
layout(location = 4) flat out uint hash;

void main() {
    LeafVertex v = leafVertex(push, uint(gl_VertexIndex), uint(gl_InstanceIndex));
    SmallLeaf light = smallLeaf(push, v);
    own = light.own;
    turned = light.turned;
    mirrored = light.mirrored;
    uvShare = vec3(v.uv + vec2(0.0, light.pictured), light.share);
    hash = v.instance.hash;
    gl_Position = frame.viewProjection * vec4(v.position, 1.0);
}
