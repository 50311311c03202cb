#pragma once

#include <cstdint>
#include <vector>

#include <glm/glm.hpp>

namespace espalier {

// What a span of bark is bent along: a cubic Bézier with its surface normal and radius at both ends.
struct BarkSpan {
    glm::vec3 p0, b1, b2, p3;
    glm::vec3 normal0, normal1;
    float radius0, radius1;
};

struct BarkVertex {
    glm::vec3 position;
    uint32_t normal;  // octahedral 2×16 snorm
};

constexpr uint32_t kLoopSides = 12, kLoopRings = 10;
constexpr uint32_t kBarkSpanVertices = kLoopSides * kLoopRings;
constexpr uint32_t kBarkSpanIndices = kLoopSides * (kLoopRings - 1) * 6;  // 216 triangles

// The other side of emit/…: writes the triangles of all spans as a C++ programmer would who cares for speed, on two
// threads, each ring's frame computed once. vertices and indices must have kBarkSpanVertices and kBarkSpanIndices a
// span.
void writeBark(const std::vector<BarkSpan>& spans, std::vector<BarkVertex>& vertices, std::vector<uint32_t>& indices);

}  // namespace espalier
