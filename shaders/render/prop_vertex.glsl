// Where a prop's vertex stands.
#ifndef ESPALIER_RENDER_PROP_VERTEX_GLSL
#define ESPALIER_RENDER_PROP_VERTEX_GLSL
#include "shaders/emit/triangle_vertex.glsl"
#include "shaders/render/frame.glsl"
#include "shaders/render/prop_records.h"

layout(set = 0, binding = 10) uniform usamplerBuffer instances;   // four words a texel
layout(set = 0, binding = 11) uniform usamplerBuffer meshes;      // two words a texel

struct PropVertex {
    vec3 position, normal;
    vec2 uv;
    float open;   // 0 to 1, of foliage: what its texture u carries, see foliage.vert
    float code;   // of a card: where it faces; -1: none
    float tint, shade, fade;   // tint: 0 to 1; shade: a factor of its brightness
    vec2 turn;   // PropInstance::turn
    float scale;
};

// From the model's space as the instance stands.
vec3 turned(PropVertex v, vec3 a) { return vec3(v.turn.x * a.x + v.turn.y * a.z, a.y, v.turn.x * a.z - v.turn.y * a.x); }

PropVertex propVertex(uint vertex, uint instance) {
    uvec4 a = texelFetch(instances, int(2u * instance)), b = texelFetch(instances, int(2u * instance + 1u));
    uvec2 p = texelFetch(meshes, int(3u * vertex)).xy, q = texelFetch(meshes, int(3u * vertex + 1u)).xy;
    vec3 at = vec3(uintBitsToFloat(p), uintBitsToFloat(q.x)), n = octahedralToUnit(q.y);
    PropVertex v;
    v.turn = uintBitsToFloat(b.xy);
    v.scale = uintBitsToFloat(a.w);
    at *= v.scale;
    v.position = uintBitsToFloat(a.xyz) + turned(v, at);
    v.normal = turned(v, n);
    v.uv = uintBitsToFloat(texelFetch(meshes, int(3u * vertex + 2u)).xy);
    bool card = v.uv.y < 0.0;
    v.open = floor(v.uv.x) * 0.125;
    v.code = card ? -1.0 - floor(v.uv.y) : -1.0;
    v.uv = card ? fract(v.uv) : v.uv;
    float tint = uintBitsToFloat(b.z);
    v.tint = fract(tint);
    v.shade = 1.0 + kShadeStep * floor(tint);
    v.fade = uintBitsToFloat(b.w);
    return v;
}
#endif
