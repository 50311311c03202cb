#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/extensions.glsl"
// The quads between two rings each: 72 indices as 36 sums of a pair of bases and a constant.
#include "shaders/emit/emit_records.h"
#include "shaders/shared/dispatch.glsl"

layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Data { TrianglesPush push; };

#define STORE(n, a, b) at.v[n] = base + (u64(a) | (u64(b) << 32));

void main() {
    uint i = itemIndex();
    const uint segments = kBarkRings - 1u;
    uint spanIndex = i / segments;
    uint ring = i - spanIndex * segments;
    if (spanIndex >= push.count) return;
    uint vertex = push.firstVertex + spanIndex * kBarkVertices + ring * kBarkSides;
    u64 base = packUint2x32(uvec2(vertex, vertex));
    uint pair = push.firstIndexPair + spanIndex * (kBarkIndices / 2u) + ring * 36u;
    U64Buf at = U64Buf(u64(push.indices) + 8ul * u64(pair));
    // A line is a quad: a b a+12, b b+12 a+12.
    STORE(0, 0, 1) STORE(1, 12, 1) STORE(2, 13, 12)
    STORE(3, 1, 2) STORE(4, 13, 2) STORE(5, 14, 13)
    STORE(6, 2, 3) STORE(7, 14, 3) STORE(8, 15, 14)
    STORE(9, 3, 4) STORE(10, 15, 4) STORE(11, 16, 15)
    STORE(12, 4, 5) STORE(13, 16, 5) STORE(14, 17, 16)
    STORE(15, 5, 6) STORE(16, 17, 6) STORE(17, 18, 17)
    STORE(18, 6, 7) STORE(19, 18, 7) STORE(20, 19, 18)
    STORE(21, 7, 8) STORE(22, 19, 8) STORE(23, 20, 19)
    STORE(24, 8, 9) STORE(25, 20, 9) STORE(26, 21, 20)
    STORE(27, 9, 10) STORE(28, 21, 10) STORE(29, 22, 21)
    STORE(30, 10, 11) STORE(31, 22, 11) STORE(32, 23, 22)
    STORE(33, 11, 0) STORE(34, 23, 0) STORE(35, 12, 23)
}
