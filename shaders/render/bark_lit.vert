#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/extensions.glsl"
// Ribbons that light_ribbons.comp has lit.
#include "shaders/render/lit_vertex.glsl"

layout(push_constant, scalar) uniform Data { TerminalPush push; };
layout(location = 0) out vec4 uvFade;      // as of bark_small.vert
layout(location = 1) out vec3 own;
layout(location = 2) out vec3 other;
layout(location = 3) flat out uint hash;

void main() {
    int at = litInstance(push, kRibbonVertices), corner = litCorner(kRibbonVertices);
    uvec4 a = texelFetch(lit, at + corner / 2), vertex = texelFetch(lit, at + 2 + corner);
    vec2 p = unpackHalf2x16(a.x), q = unpackHalf2x16(a.y), r = unpackHalf2x16(a.z), s = unpackHalf2x16(a.w);
    uvFade = vec4(litUv(vertex), s.y, s.x);
    own = vec3(p, q.x);
    other = vec3(q.y, r);
    hash = 0u;
    gl_Position = litPosition(vertex);
}
