#pragma once

#include <algorithm>
#include <glm/glm.hpp>
#include <utility>

namespace sample {

// The share of the way from a to b that lies nearest to p, 0 to 1, and how near.
inline std::pair<float, float> nearestOn(glm::vec2 a, glm::vec2 b, glm::vec2 p) {
    const glm::vec2 ab = b - a;
    const float t = std::clamp(glm::dot(p - a, ab) / std::max(glm::dot(ab, ab), 1e-9f), 0.f, 1.f);
    return {t, glm::distance(p, a + t * ab)};
}

}  // namespace sample
