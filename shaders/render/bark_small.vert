#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/extensions.glsl"
// Ribbons of bark, a few pixels wide: lit at each vertex.
#include "shaders/render/bark_small_light.glsl"
#include "shaders/render/bark_vertex.glsl"

layout(push_constant, scalar) uniform Data { TerminalPush push; };
layout(location = 0) out vec4 uvFade;      // uv; fade; share of the light that is the sky's
layout(location = 1) out vec3 own;         // light on a texel's colour,
layout(location = 2) out vec3 other;       // and what needs none
layout(location = 3) flat out uint hash;

void main() {
    BarkVertex v = barkVertex(push, uint(gl_VertexIndex), uint(gl_InstanceIndex));
    SmallBark light = smallBark(push, v.position, normalize(v.normal), v.radius);
    own = light.own;
    other = light.other;
    float along = v.metres * smallBarkScale(v.span.radius0, v.span.radius1);
    uvFade = vec4(v.around, along, barkFade(v.span), light.share);
    hash = barkHash(v.span);
    gl_Position = frame.viewProjection * vec4(v.position, 1.0);
}
