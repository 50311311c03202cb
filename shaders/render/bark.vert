#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/extensions.glsl"
// Bark, to be lit at each pixel.
#include "shaders/render/bark_vertex.glsl"

layout(push_constant, scalar) uniform Data { TerminalPush push; };
layout(location = 0) out vec3 position;
layout(location = 1) out vec3 normal;
layout(location = 2) out vec4 along;       // u around, metres along, log2 of the radius, fade
layout(location = 3) flat out uint hash;

void main() {
    BarkVertex v = barkVertex(push, uint(gl_VertexIndex), uint(gl_InstanceIndex));
    position = v.position;
    normal = v.normal;
    along = vec4(v.around, v.metres, log2(max(v.radius, 1e-9)), barkFade(v.span));
    hash = barkHash(v.span);
    gl_Position = frame.viewProjection * vec4(position, 1.0);
}
