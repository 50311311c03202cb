#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/glm.hpp>

namespace espalier {

// The distance from a point to a triangle that has area.
inline double distanceToTriangle(glm::dvec3 p, const std::array<glm::dvec3, 3>& corner) {
    const glm::dvec3 n = glm::cross(corner[1] - corner[0], corner[2] - corner[0]);
    bool within = true;
    double least = 1e300;
    for (size_t k = 0; k < 3; ++k) {
        const glm::dvec3 e = corner[(k + 1) % 3] - corner[k], r = p - corner[k];
        within = within && glm::dot(glm::cross(n, e), r) >= 0;
        least = std::min(least, glm::length(r - e * std::clamp(glm::dot(r, e) / glm::dot(e, e), 0.0, 1.0)));
    }
    return within ? std::abs(glm::dot(n, p - corner[0])) / glm::length(n) : least;
}

}  // namespace espalier
