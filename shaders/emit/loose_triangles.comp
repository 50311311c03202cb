#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/extensions.glsl"
// A loose terminal each: its mesh's vertices in the world and its indices. The mesh is the same for all of a dispatch.
#include "shaders/emit/triangle_vertex.glsl"
#include "shaders/shared/dispatch.glsl"

layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Data { TrianglesPush push; };

void main() {
    uint i = itemIndex();
    if (i >= push.count) return;
    LeafInstance o = push.leaves.v[push.drawn.v[push.firstInstance + i].item];
    float rcpSize = inversesqrt(max(dot(o.axisX, o.axisX), 1e-30));
    uint firstVertex = push.firstVertex + i * push.meshVertexCount;
    U64Buf vertices = vertexAddress(push.vertices, firstVertex);
    for (uint j = 0u; j < push.meshVertexCount; ++j) {
        TerminalVertex mesh = push.meshVertices.v[push.meshFirstVertex + j];
        vec3 p = o.origin + o.axisX * mesh.position.x + o.axisY * mesh.position.y + o.axisZ * mesh.position.z;
        vec3 n = octahedralToUnit(mesh.normal) * rcpSize;
        n = o.axisX * n.x + o.axisY * n.y + o.axisZ * n.z;
        writeVertex(vertices, j, p, octahedral(n));
    }
    // A mesh with an odd number of indices can't be written in pairs.
    u64 base = packUint2x32(uvec2(firstVertex, firstVertex));
    uint pairs = push.meshIndexCount >> 1u;
    if ((push.meshIndexCount & 1u) == 0u) {
        U64Buf at = U64Buf(u64(push.indices) + 8ul * u64(push.firstIndexPair + i * pairs));
        for (uint j = 0u; j < pairs; ++j) {
            uint a = push.meshIndices.v[push.meshFirstIndex + 2u * j];
            uint b = push.meshIndices.v[push.meshFirstIndex + 2u * j + 1u];
            at.v[j] = base + packUint2x32(uvec2(a, b));
        }
        return;
    }
    UintBuf words = UintBuf(u64(push.indices) + 8ul * u64(push.firstIndexPair) + 4ul * u64(i * push.meshIndexCount));
    for (uint j = 0u; j < push.meshIndexCount; ++j)
        words.v[j] = firstVertex + push.meshIndices.v[push.meshFirstIndex + j];
}
