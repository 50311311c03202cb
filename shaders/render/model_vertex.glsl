// A vertex of the surface's own mesh: all that shading asks for, or, where ESPALIER_DEPTH_ONLY is defined, its place, with
// ESPALIER_CUT_OUT also where it lies in its picture. ESPALIER_MAPPED: of two UV sets.
// Drawn twice: what is shaded must meet the depth that went ahead, so positions are never fused or reordered.
#include "shaders/render/frame.glsl"

layout(push_constant, scalar) uniform Data { ModelPush push; };
layout(location = 0) in vec3 atVertex;
#ifndef ESPALIER_DEPTH_ONLY
layout(location = 1) in vec3 vertexNormal;
layout(location = 2) in vec4 vertexTangent;
layout(location = 3) in vec4 vertexUvs;   // of the textures, of the walk
layout(location = 5) in vec4 vertexColour;   // linear
layout(location = 0) out vec3 position;
layout(location = 1) out vec3 normal;
layout(location = 2) out vec4 tangent;
layout(location = 3) out vec4 uvs;
layout(location = 5) out vec4 tint;   // the vertex's colour
#ifdef ESPALIER_MAPPED
layout(location = 4) in vec2 vertexOtherUv;
layout(location = 4) out vec2 otherUv;
#endif
#elif defined(ESPALIER_CUT_OUT)
layout(location = 3) in vec4 vertexUvs;
layout(location = 4) in vec2 vertexOtherUv;
layout(location = 5) in vec4 vertexColour;
layout(location = 0) out vec3 uvAlpha;
#endif

// Of a row of the placing matrix. No dot product: that would be left to the compiler.
float placed(vec4 row) {
    precise float at = row.x * atVertex.x + row.y * atVertex.y + row.z * atVertex.z + row.w;
    return at;
}

void main() {
    vec3 at = vec3(placed(push.toWorld[0]), placed(push.toWorld[1]), placed(push.toWorld[2]));
#ifndef ESPALIER_DEPTH_ONLY
    position = at;
    normal = vec3(dot(push.toWorld[0].xyz, vertexNormal), dot(push.toWorld[1].xyz, vertexNormal), dot(push.toWorld[2].xyz, vertexNormal));
    tangent = vec4(dot(push.toWorld[0].xyz, vertexTangent.xyz), dot(push.toWorld[1].xyz, vertexTangent.xyz),
                   dot(push.toWorld[2].xyz, vertexTangent.xyz), push.mirrored != 0u ? -vertexTangent.w : vertexTangent.w);
    uvs = vertexUvs;
    tint = vertexColour;
#ifdef ESPALIER_MAPPED
    otherUv = vertexOtherUv;
#endif
#elif defined(ESPALIER_CUT_OUT)
    vec3 looked = vec3(push.colorOther != 0u ? vertexOtherUv : vertexUvs.xy, 1.0);
    uvAlpha = vec3(dot(push.colorU, looked), dot(push.colorV, looked), vertexColour.a);
#endif
    precise vec4 clip = frame.viewProjection * vec4(at, 1.0);
    gl_Position = clip;
}
