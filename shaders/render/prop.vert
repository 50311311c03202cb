#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/extensions.glsl"
// What is built: lit at each pixel.
#include "shaders/render/prop_vertex.glsl"

layout(push_constant, scalar) uniform Data { PropPush push; };
layout(location = 0) out vec3 position;
layout(location = 1) out vec3 normal;
layout(location = 2) out vec2 uv;
layout(location = 3) flat out vec2 tintFade;

void main() {
    PropVertex v = propVertex(uint(gl_VertexIndex), push.firstInstance + uint(gl_InstanceIndex));
    position = v.position;
    normal = v.normal;
    uv = v.uv;
    tintFade = vec2(v.tint, v.fade);
    gl_Position = frame.viewProjection * vec4(position, 1.0);
}
