// In: numbers. Out: the woven sphere's vertices. Built with -O3; it shares no code with the kernels.
#include "tools/bench/graph_loop.hpp"

#include <cmath>
#include <glm/glm.hpp>
#include <random>

namespace espalier {
namespace {

constexpr float kSpeed = 0.0025f, kRadius = 0.025f;

uint32_t octahedral(glm::vec3 n) {
    const float k = 1 / (std::fabs(n.x) + std::fabs(n.y) + std::fabs(n.z));
    float x = n.x * k, y = n.y * k;
    if (n.z < 0) {
        const float folded = (1 - std::fabs(y)) * std::copysign(1.0f, x);
        y = (1 - std::fabs(x)) * std::copysign(1.0f, y);
        x = folded;
    }
    const auto quantise = [](float v) { return uint32_t(int(v * 32767.0f + std::copysign(0.5f, v))) & 0xFFFFu; };
    return quantise(x) | (quantise(y) << 16);
}

}  // namespace

WovenLoop::WovenLoop(uint32_t p, uint32_t c, uint32_t v, uint32_t u)
    : points(p),
      curves(c),
      keys(8),
      samples(v),
      sides(u),
      path(v),
      vertices(size_t(c) * v * u),
      normals(vertices.size()) {
    std::mt19937 random(1);
    std::uniform_real_distribution<float> any(-1, 1);
    for (uint32_t i = 0; i < points; ++i) {
        particles.emplace_back(any(random), any(random), any(random));
        glm::vec3 d;
        do d = {any(random), any(random), any(random)};
        while (glm::dot(d, d) > 1);
        velocities.push_back(glm::normalize(d) * kSpeed);
    }
    for (uint32_t i = 0; i < curves * keys; ++i) subsets.push_back(uint32_t(random() % points));
    for (uint32_t i = 0; i < sides; ++i) {
        const float angle = 6.2831853f * float(i) / float(sides - 1);
        ring.emplace_back(std::cos(angle), std::sin(angle), 0);
    }
}

void WovenLoop::step() {
    for (uint32_t i = 0; i < points; ++i)
        for (int k = 0; k < 3; ++k) {
            float& x = particles[i][k];
            x += velocities[i][k];
            if (x > 1 || x < -1) {
                x = x > 1 ? 2 - x : -2 - x;
                velocities[i][k] = -velocities[i][k];
            }
        }
    size_t out = 0;
    for (uint32_t c = 0; c < curves; ++c) {
        const uint32_t* subset = &subsets[size_t(c) * keys];
        const auto key = [&](uint32_t k) { return particles[subset[k]]; };
        for (uint32_t j = 0; j < samples; ++j) {
            const float along = float(j) * float(keys - 1) / float(samples - 1);
            const uint32_t s = std::min(uint32_t(along), keys - 2);
            const float t = along - float(s), w = 1 - t;
            const glm::vec3 p0 = key(s), p3 = key(s + 1);
            const glm::vec3 p1 = p0 + (p3 - key(s > 0 ? s - 1 : 0)) * (1 / 6.0f);
            const glm::vec3 p2 = p3 - (key(std::min(s + 2, keys - 1)) - p0) * (1 / 6.0f);
            path[j] = glm::normalize(p0 * (w * w * w) + p1 * (3 * t * w * w) + p2 * (3 * t * t * w) + p3 * (t * t * t));
        }
        glm::vec3 along(0), side(0);
        for (uint32_t j = 0; j < samples; ++j) {
            const glm::vec3 next = glm::normalize(path[std::min(j + 1, samples - 1)] - path[j > 0 ? j - 1 : 0]);
            if (j == 0) {
                const glm::vec3 axis = std::fabs(next.x) < 0.6f ? glm::vec3(1, 0, 0) : glm::vec3(0, 1, 0);
                side = glm::normalize(axis - next * glm::dot(axis, next));
            } else {
                const glm::vec3 v1 = path[j] - path[j - 1];
                const float k1 = 2 / glm::dot(v1, v1);
                const glm::vec3 v2 = next - (along - v1 * (k1 * glm::dot(v1, along)));
                side -= v1 * (k1 * glm::dot(v1, side));
                const float d2 = glm::dot(v2, v2);
                if (d2 > 0) side -= v2 * (2 / d2 * glm::dot(v2, side));
                side = glm::normalize(side - next * glm::dot(next, side));
            }
            along = next;
            const glm::vec3 other = glm::cross(along, side);
            for (uint32_t u = 0; u < sides; ++u, ++out) {
                const glm::vec3 n = side * ring[u].x + other * ring[u].y;
                vertices[out] = path[j] + n * kRadius;
                normals[out] = octahedral(n);
            }
        }
    }
}

}  // namespace espalier
