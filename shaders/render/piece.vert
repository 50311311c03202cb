#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/extensions.glsl"
// A piece of a pattern: a mesh under three axes and a place.
#include "shaders/emit/triangle_vertex.glsl"
#include "shaders/render/frame.glsl"
#include "shaders/render/piece_records.h"
#include "shaders/shared/pattern_piece.h"

layout(push_constant, scalar) uniform Data { PiecePush push; };
layout(set = 0, binding = 10) uniform usamplerBuffer instances;   // four words a texel
layout(set = 0, binding = 11) uniform usamplerBuffer meshes;      // two words a texel
layout(location = 0) out vec3 position;
layout(location = 1) out vec3 normal;
layout(location = 2) flat out vec3 base;
layout(location = 3) out vec3 uvFade;
layout(location = 4) flat out float turned;   // below 0: its axes mirror

// Of a piece without a colour of its own.
const vec3 kPlain = vec3(0.42, 0.39, 0.33);

// A mesh along the curve of a segment (pattern_piece.h). Within x = +-0.5 it is stretched along the curve; beyond, it is
// as wide as the line. Returns where vertex v lies; n: in, the mesh's normal; out, the world's.
vec3 bentAlong(vec3 begin, vec3 chord, vec3 up0, uvec3 packed, vec3 v, inout vec3 n) {
    float width = length(up0);
    float t = clamp(v.x + 0.5, 0.0, 1.0), u = 1.0 - t, third = length(chord) / 3.0;
    vec3 p1 = octahedralToUnit(packed.x) * third, p2 = chord - octahedralToUnit(packed.y) * third;
    vec3 middle = begin + p1 * (3.0 * t * u * u) + p2 * (3.0 * t * t * u) + chord * (t * t * t);
    vec3 along = normalize(p1 * (u * u) + (p2 - p1) * (2.0 * t * u) + (chord - p2) * (t * t));
    vec3 side = normalize(cross(along, mix(up0 / width, octahedralToUnit(packed.z), t)));
    vec3 up = cross(side, along);
    n = along * (n.x * (v.x + 0.5 == t ? width / (3.0 * third) : 1.0)) + up * n.y + side * n.z;
    return middle + (along * (v.x + 0.5 - t) + up * v.y + side * v.z) * width;
}

void main() {
    int at = 4 * int(push.firstInstance + uint(gl_InstanceIndex));
    uvec4 a = texelFetch(instances, at), b = texelFetch(instances, at + 1);
    uvec4 c = texelFetch(instances, at + 2), d = texelFetch(instances, at + 3);
    vec3 x = uintBitsToFloat(a.xyz), y = uintBitsToFloat(uvec3(a.w, b.xy)), z = uintBitsToFloat(uvec3(b.zw, c.x));
    int vertex = 3 * gl_VertexIndex;
    uvec2 p = texelFetch(meshes, vertex).xy, q = texelFetch(meshes, vertex + 1).xy;
    vec3 v = vec3(uintBitsToFloat(p), uintBitsToFloat(q.x)), n = octahedralToUnit(q.y);
    turned = 1.0;
    if ((d.x & kPieceLine) != 0u) {
        normal = n;
        position = bentAlong(uintBitsToFloat(c.yzw), x, y, floatBitsToUint(z), v, normal);
    } else {
        position = uintBitsToFloat(c.yzw) + x * v.x + y * v.y + z * v.z;
        // The axes are at right angles, so their inverse transpose is each over the square of its length.
        turned = dot(cross(x, y), z);
        normal = x * (n.x / dot(x, x)) + y * (n.y / dot(y, y)) + z * (n.z / dot(z, z));
    }
    vec3 own = vec3((uvec3(d.z) >> uvec3(20u, 10u, 0u)) & 1023u) * (1.0 / 1023.0);
    base = d.z != 0xFFFFFFFFu ? own : push.textured != 0u ? vec3(1.0) : kPlain;
    uvFade = vec3(uintBitsToFloat(texelFetch(meshes, vertex + 2).xy), uintBitsToFloat(d.y));
    gl_Position = frame.viewProjection * vec4(position, 1.0);
}
