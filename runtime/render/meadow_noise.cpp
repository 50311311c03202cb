// Enters: texels, places. Leaves: noise from hashed lattices; the hue that meadow.glsl gives the ground there.
#include "runtime/render/meadow_noise.hpp"

#include <algorithm>
#include <cmath>

#include "runtime/core/jobs.hpp"
#include "shaders/render/meadow_hue.h"

namespace espalier {

float lattice(uint32_t x, uint32_t y, uint32_t salt) {
    uint32_t h = x * 0x9E3779B1u ^ y * 0x85EBCA77u ^ salt * 0xC2B2AE3Du;
    h = (h ^ (h >> 15)) * 0x2C1B3C6Du;
    h = (h ^ (h >> 13)) * 0x297A2D39u;
    return float((h ^ (h >> 16)) >> 8) / 8388608.0f - 1;
}

float octaves(uint32_t x, uint32_t y, uint32_t cells, int count, uint32_t salt) {
    float sum = 0, weight = 0.5f;
    for (int o = 0; o < count; ++o, cells *= 2, weight *= 0.55f) {
        const float fx = float(x) * float(cells) / kNoiseSide, fy = float(y) * float(cells) / kNoiseSide;
        const auto ix = uint32_t(fx), iy = uint32_t(fy);
        const auto ease = [](float t) { return t * t * (3 - 2 * t); };
        const float u = ease(fx - float(ix)), v = ease(fy - float(iy));
        const auto at = [&](uint32_t dx, uint32_t dy) {
            return lattice((ix + dx) % cells, (iy + dy) % cells, salt + uint32_t(o));
        };
        sum += weight * std::lerp(std::lerp(at(0, 0), at(1, 0), u), std::lerp(at(0, 1), at(1, 1), u), v);
    }
    return sum;
}

namespace {

// From the heights at a texel, and at the next ones of its row and column.
glm::vec4 meadowNoise(uint32_t x, uint32_t y, float height, float right, float below) {
    return {1.4f * octaves(x, y, 4, 5, 11), 0, 6 * (right - height), 6 * (below - height)};
}

float meadowHeight(uint32_t x, uint32_t y) {
    return octaves(x % kNoiseSide, y % kNoiseSide, 16, 4, 31);
}

}  // namespace

glm::vec4 meadowNoise(uint32_t x, uint32_t y) {
    return meadowNoise(x, y, meadowHeight(x, y), meadowHeight(x + 1, y), meadowHeight(x, y + 1));
}

std::vector<glm::vec4> meadowNoiseTile() {
    std::vector<float> heights(size_t(kNoiseSide) * kNoiseSide);
    std::vector<glm::vec4> tile(heights.size());
    const auto overTexels = [](const auto& body) {
        parallelFor(kNoiseSide, 16, [&](size_t begin, size_t end) {
            for (size_t y = begin; y < end; ++y)
                for (uint32_t x = 0; x < kNoiseSide; ++x) body(x, uint32_t(y), y * kNoiseSide + x);
        });
    };
    overTexels([&](uint32_t x, uint32_t y, size_t i) { heights[i] = meadowHeight(x, y); });
    overTexels([&](uint32_t x, uint32_t y, size_t i) {
        const size_t right = size_t(y) * kNoiseSide + (x + 1) % kNoiseSide;
        const size_t below = size_t((y + 1) % kNoiseSide) * kNoiseSide + x;
        tile[i] = meadowNoise(x, y, heights[i], heights[right], heights[below]);
    });
    return tile;
}

MeadowHue meadowHue(glm::vec2 place) {
    const glm::vec2 tile = place / kMeadowTile, texel = (tile - glm::floor(tile)) * float(kNoiseSide);
    const glm::vec4 broad = meadowNoise(uint32_t(texel.x) % kNoiseSide, uint32_t(texel.y) % kNoiseSide);
    const glm::vec3 weights(0.3f, 0.6f, 0.1f);  // of brightness
    const glm::vec3 tint = swatheTint(std::clamp(broadSwathe(broad), 0.0f, 1.0f));
    return {std::clamp(kMeadowDry + broadDryness(broad), 0.0f, kMeadowMostDry),
            broadGrowth(broad) * glm::dot(tint, weights)};
}

}  // namespace espalier
