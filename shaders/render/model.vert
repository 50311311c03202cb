#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/extensions.glsl"
// The surface's own mesh.
#include "shaders/render/frame.glsl"

layout(push_constant, scalar) uniform Data { ModelPush push; };
layout(location = 0) out vec3 position;
layout(location = 1) out vec3 normal;
layout(location = 2) out vec4 tangent;
layout(location = 3) out vec4 uvs;

void main() {
    ModelVertex v = push.vertices.v[gl_VertexIndex];
    vec4 p = vec4(v.position, 1.0);
    position = vec3(dot(push.toWorld[0], p), dot(push.toWorld[1], p), dot(push.toWorld[2], p));
    normal = vec3(dot(push.toWorld[0].xyz, v.normal), dot(push.toWorld[1].xyz, v.normal), dot(push.toWorld[2].xyz, v.normal));
    tangent = vec4(dot(push.toWorld[0].xyz, v.tangent.xyz), dot(push.toWorld[1].xyz, v.tangent.xyz),
                   dot(push.toWorld[2].xyz, v.tangent.xyz), v.tangent.w);
    uvs = vec4(v.uv, v.walkUv);
    gl_Position = frame.viewProjection * vec4(position, 1.0);
}
