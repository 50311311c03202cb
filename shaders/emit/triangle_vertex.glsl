// Writing TriangleVertex as two 64-bit words, and octahedral normals with the device's own arithmetic: nothing is
// decided by these.
#ifndef ESPALIER_EMIT_TRIANGLE_VERTEX_GLSL
#define ESPALIER_EMIT_TRIANGLE_VERTEX_GLSL
#include "shaders/emit/emit_records.h"

// k: 1 / (|x| + |y| + |z|).
uint octahedralScaled(vec3 n, float k) {
    vec2 p = n.xy * k;
    vec2 folded = (vec2(1.0) - abs(p.yx)) * vec2(p.x < 0.0 ? -1.0 : 1.0, p.y < 0.0 ? -1.0 : 1.0);
    p = n.z < 0.0 ? folded : p;
    // Rounded by the bias that makes both numbers positive; the bias' own bits fall away.
    uvec2 q = uvec2(p * 32767.0 + 65536.5);
    return (q.x & 0xFFFFu) | (q.y << 16u);
}
uint octahedral(vec3 n) { return octahedralScaled(n, 1.0 / (abs(n.x) + abs(n.y) + abs(n.z))); }

vec3 octahedralToUnit(uint bits) {
    vec2 p = unpackSnorm2x16(bits);
    float z = 1.0 - abs(p.x) - abs(p.y);
    float t = max(-z, 0.0);
    vec3 n = vec3(p.x + (p.x >= 0.0 ? -t : t), p.y + (p.y >= 0.0 ? -t : t), z);
    return n * inversesqrt(max(dot(n, n), 1e-30));
}

// `at`: the vertex' own address, so that writes at constant distances share one computation.
void writeVertex(U64Buf at, uint index, vec3 position, uint normal) {
    at.v[2u * index] = packUint2x32(uvec2(floatBitsToUint(position.x), floatBitsToUint(position.y)));
    at.v[2u * index + 1u] = packUint2x32(uvec2(floatBitsToUint(position.z), normal));
}
U64Buf vertexAddress(U64Buf vertices, uint index) { return U64Buf(u64(vertices) + 16ul * u64(index)); }
#endif
