#pragma once

#include <algorithm>
#include <iterator>

#include <glm/glm.hpp>

namespace espalier {

// The sides of a view, by its matrix from the world to clip space, each with its inside in front; the far one is at
// infinity.
struct ViewSides {
    glm::vec4 planes[5];

    explicit ViewSides(const glm::mat4& m) {
        const auto row = [&](int r) { return glm::vec4(m[0][r], m[1][r], m[2][r], m[3][r]); };
        const glm::vec4 found[5] = {row(3) + row(0), row(3) - row(0), row(3) + row(1), row(3) - row(1), row(3)};
        for (int i = 0; i < 5; ++i) planes[i] = found[i] / std::max(glm::length(glm::vec3(found[i])), 1e-12f);
    }
    // Whether a box lies wholly behind one of them.
    bool misses(glm::vec3 low, glm::vec3 high) const {
        return std::any_of(std::begin(planes), std::end(planes), [&](glm::vec4 p) {
            const glm::vec3 foremost = glm::mix(low, high, glm::greaterThan(glm::vec3(p), glm::vec3(0)));
            return glm::dot(p, glm::vec4(foremost, 1)) < 0;
        });
    }
};

}  // namespace espalier
