// The carved disc in the court's wall. In: a point relative to its middle, the wall's own detail. Out: dressed stone
// with the carving's relief, its depths darkened.

#include <algorithm>
#include <cmath>

#include "tools/content/masonry.hpp"
#include "tools/content/maths.hpp"
#include "tools/content/noise.hpp"

namespace espalier::content {
namespace {

constexpr float kTurn = 2 * 3.14159265f;

float torus(float r, float middle, float half) {
    float x = (r - middle) / half;
    return half * std::sqrt(std::max(0.0f, 1 - x * x));
}

// Leaves in pairs along a ring, pointing one way round; each rises towards its middle rib.
float wreath(float r, float angle) {
    float along = angle * 22 / kTurn;
    float height = 0;
    for (float side : {-1.0f, 1.0f}) {
        float v = (r - 0.285f) * side;  // from the stem outwards
        float u = along - v * 9 - (side > 0 ? 0.5f : 0.0f);
        u = 2 * std::abs(u - std::floor(u) - 0.5f);
        float blade = ramp(1.0f, 0.25f, u) * ramp(-0.004f, 0.012f, v) * ramp(0.068f, 0.045f, v + 0.02f * u);
        height = std::max(height, 0.022f * blade * (1 - 0.3f * ramp(0.2f, 0.0f, u)));
    }
    return std::max(height, 0.7f * torus(r, 0.285f, 0.009f));
}

float rosette(float r, float angle) {
    float outer = 0.150f + 0.030f * std::cos(6 * angle), inner = 0.085f + 0.022f * std::cos(6 * angle + 3.14159f);
    float height = 0.024f * ramp(outer, outer - 0.045f, r) * (0.6f + 0.4f * std::abs(std::sin(3 * angle)));
    height = std::max(height, 0.034f * ramp(inner, inner - 0.03f, r));
    return height + 0.5f * torus(r, 0, 0.036f);
}

float relief(glm::vec2 p) {
    float r = glm::length(p), angle = std::atan2(p.x, p.y);
    float height = -0.012f * ramp(0.405f, 0.385f, r);
    height = std::max(height, 0.8f * torus(r, 0.43f, 0.026f));
    height += 0.6f * torus(r, 0.375f, 0.008f);
    return height + (r > 0.2f ? wreath(r, angle) : rosette(r, angle));
}

}  // namespace

Detail tondoDetail(glm::vec2 local, const StoneLook& look, const Detail& wall) {
    float r = glm::length(local);
    float inside = ramp(kTondoRadius + 0.006f, kTondoRadius - 0.006f, r);
    if (inside <= 0) return wall;
    StoneLook dressed = look;
    dressed.roughness = 0.22f;
    dressed.shift = 0;
    Detail stone = stoneDetail({9001, 1, 1, local}, dressed);
    float carved = relief(local), worn = 0.004f * fractal(look.block * 9.0f, 831, 3);
    stone.height += 0.012f + carved + worn;
    stone.albedo = glm::clamp(stone.albedo * (1.06f + 14 * glm::clamp(carved, -0.02f, 0.03f) - 0.12f), 0.01f, 0.8f);
    float groove = ramp(0.016f, 0.0f, std::abs(r - kTondoRadius));
    stone.albedo *= 1 - 0.6f * groove;
    stone.height -= 0.012f * groove;
    return {glm::mix(wall.height, stone.height, inside), glm::mix(wall.albedo, stone.albedo, inside)};
}

}  // namespace espalier::content
