// A vertex of the surface's own mesh: all that shading asks for, or, where ESPALIER_DEPTH_ONLY is defined, its place.
// Drawn twice: what is shaded must meet the depth that went ahead, so positions are never fused or reordered.
#include "shaders/render/frame.glsl"

layout(push_constant, scalar) uniform Data { ModelPush push; };
layout(location = 0) in vec3 atVertex;
#ifndef ESPALIER_DEPTH_ONLY
layout(location = 1) in vec3 vertexNormal;
layout(location = 2) in vec4 vertexTangent;
layout(location = 3) in vec4 vertexUvs;   // of the textures, of the walk
layout(location = 0) out vec3 position;
layout(location = 1) out vec3 normal;
layout(location = 2) out vec4 tangent;
layout(location = 3) out vec4 uvs;
#else
vec3 position;
#endif

void main() {
    vec4 p = vec4(atVertex, 1.0);
    position = vec3(dot(push.toWorld[0], p), dot(push.toWorld[1], p), dot(push.toWorld[2], p));
#ifndef ESPALIER_DEPTH_ONLY
    normal = vec3(dot(push.toWorld[0].xyz, vertexNormal), dot(push.toWorld[1].xyz, vertexNormal), dot(push.toWorld[2].xyz, vertexNormal));
    tangent = vec4(dot(push.toWorld[0].xyz, vertexTangent.xyz), dot(push.toWorld[1].xyz, vertexTangent.xyz),
                   dot(push.toWorld[2].xyz, vertexTangent.xyz), vertexTangent.w);
    uvs = vertexUvs;
#endif
    precise vec4 clip = frame.viewProjection * vec4(position, 1.0);
    gl_Position = clip;
}
