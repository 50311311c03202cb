// Enters: texels, places. Leaves: noise from hashed lattices; the hue that meadow.glsl gives the ground there.
#include "runtime/render/meadow_noise.hpp"

#include <algorithm>
#include <cmath>

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

glm::vec4 meadowNoise(uint32_t x, uint32_t y) {
    const auto height = [](uint32_t u, uint32_t v) { return octaves(u % kNoiseSide, v % kNoiseSide, 16, 4, 31); };
    return {1.4f * octaves(x, y, 4, 5, 11), 0, 6 * (height(x + 1, y) - height(x, y)),
            6 * (height(x, y + 1) - height(x, y))};
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
