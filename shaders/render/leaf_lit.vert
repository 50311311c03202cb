#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/extensions.glsl"
// Leaves that light_leaves.comp has lit.
#include "shaders/render/lit_vertex.glsl"

layout(constant_id = kConstantCorners) const uint corners = 3;
layout(push_constant, scalar) uniform Data { TerminalPush push; };
layout(location = 0) out vec2 uv;
layout(location = 1) flat out vec4 ownShare;
layout(location = 2) flat out vec3 turned;
layout(location = 3) flat out vec3 mirrored;

void main() {
    int at = litInstance(push, corners);
    uvec4 a = texelFetch(lit, at), vertex = texelFetch(lit, at + 2 + litCorner(corners));
    uint b = texelFetch(lit, at + 1).x;
    vec2 p = unpackHalf2x16(a.x), q = unpackHalf2x16(a.y), r = unpackHalf2x16(a.z), s = unpackHalf2x16(a.w), t = unpackHalf2x16(b);
    uv = litUv(vertex);
    ownShare = vec4(p, q.x, t.y);
    turned = vec3(q.y, r);
    mirrored = vec3(s, t.x);
    gl_Position = litPosition(vertex);
}
