// Enters: spans. Leaves: their triangles in memory. Built with -O3 -march=native and fast arithmetic; it shares no
// code with the kernels.
#include "tools/bench/bark_loop.hpp"

#include <array>
#include <cmath>
#include <thread>

namespace espalier {
namespace {

struct Circle {
    std::array<float, kLoopSides> c, s;
    Circle() {
        for (uint32_t i = 0; i < kLoopSides; ++i) {
            c[i] = std::cos(6.2831853f * float(i) / float(kLoopSides));
            s[i] = std::sin(6.2831853f * float(i) / float(kLoopSides));
        }
    }
};

inline uint32_t octahedral(glm::vec3 n) {
    float k = 1.0f / (std::fabs(n.x) + std::fabs(n.y) + std::fabs(n.z));
    float x = n.x * k, y = n.y * k;
    float fx = (1.0f - std::fabs(y)) * std::copysign(1.0f, x), fy = (1.0f - std::fabs(x)) * std::copysign(1.0f, y);
    x = n.z < 0 ? fx : x;
    y = n.z < 0 ? fy : y;
    auto quantise = [](float v) { return uint32_t(int(v * 32767.0f + std::copysign(0.5f, v))) & 0xFFFFu; };
    return quantise(x) | (quantise(y) << 16);
}

void writeRing(const BarkSpan& span, const Circle& circle, uint32_t ring, BarkVertex* out) {
    float t = float(ring) / float(kLoopRings - 1), u = 1 - t;
    glm::vec3 centre = u * u * u * span.p0 + 3 * u * u * t * span.b1 + 3 * u * t * t * span.b2 + t * t * t * span.p3;
    glm::vec3 tangent = u * u * (span.b1 - span.p0) + 2 * u * t * (span.b2 - span.b1) + t * t * (span.p3 - span.b2);
    glm::vec3 across = glm::normalize(glm::cross(tangent, u * span.normal0 + t * span.normal1));
    glm::vec3 up = glm::normalize(glm::cross(across, tangent));
    float radius = u * span.radius0 + t * span.radius1;
    for (uint32_t i = 0; i < kLoopSides; ++i) {
        glm::vec3 n = across * circle.c[i] + up * circle.s[i];
        out[i] = {centre + radius * n, octahedral(n)};
    }
}

void writeIndices(uint32_t firstVertex, uint32_t* out) {
    for (uint32_t ring = 0; ring + 1 < kLoopRings; ++ring)
        for (uint32_t i = 0; i < kLoopSides; ++i) {
            uint32_t a = firstVertex + ring * kLoopSides + i;
            uint32_t b = firstVertex + ring * kLoopSides + (i + 1) % kLoopSides;
            out[0] = a;
            out[1] = b;
            out[2] = a + kLoopSides;
            out[3] = b;
            out[4] = b + kLoopSides;
            out[5] = a + kLoopSides;
            out += 6;
        }
}

}  // namespace

void writeBark(const std::vector<BarkSpan>& spans, std::vector<BarkVertex>& vertices, std::vector<uint32_t>& indices) {
    const Circle circle;
    auto work = [&](size_t first, size_t last) {
        for (size_t s = first; s < last; ++s) {
            for (uint32_t ring = 0; ring < kLoopRings; ++ring)
                writeRing(spans[s], circle, ring, &vertices[s * kBarkSpanVertices + ring * kLoopSides]);
            writeIndices(uint32_t(s * kBarkSpanVertices), &indices[s * kBarkSpanIndices]);
        }
    };
    std::thread second(work, spans.size() / 2, spans.size());
    work(0, spans.size() / 2);
    second.join();
}

}  // namespace espalier
