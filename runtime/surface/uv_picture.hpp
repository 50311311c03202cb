#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

namespace espalier {

// One channel over a UV square; rows from v = 0 on, width * height values.
struct UvPicture {
    uint32_t width = 0, height = 0;
    std::vector<float> texels;
    bool empty() const { return texels.empty(); }

    // Between the four texels around uv; beyond the square, what is at its border.
    float at(glm::vec2 uv) const {
        const glm::vec2 last(float(width - 1), float(height - 1));
        const glm::vec2 p = glm::clamp(uv * (last + 1.0f) - 0.5f, glm::vec2(0), last);
        const glm::uvec2 low(p), high = glm::min(low + 1u, glm::uvec2(last));
        const glm::vec2 f = p - glm::vec2(low);
        auto texel = [&](uint32_t x, uint32_t y) { return texels[size_t(y) * width + x]; };
        return (texel(low.x, low.y) * (1 - f.x) + texel(high.x, low.y) * f.x) * (1 - f.y) +
               (texel(low.x, high.y) * (1 - f.x) + texel(high.x, high.y) * f.x) * f.y;
    }
};

}  // namespace espalier
