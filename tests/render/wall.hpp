#pragma once

#include "runtime/surface/surface.hpp"

namespace espalier::test {

// A wall z = 0 and the ground y = 0.
inline SurfaceData wall(float width, float height) {
    SurfaceData data;
    auto quad = [&](glm::vec3 origin, glm::vec3 u, glm::vec3 v) {
        const uint32_t first = uint32_t(data.vertices.size());
        const glm::vec3 n = glm::normalize(glm::cross(u, v));
        for (int i = 0; i < 4; ++i) {
            const glm::vec2 at(i & 1, i >> 1);
            data.vertices.push_back({origin + u * at.x + v * at.y, n, glm::vec4(glm::normalize(u), 1), at, at});
        }
        for (uint32_t i : {0u, 1u, 2u, 1u, 3u, 2u}) data.indices.push_back(first + i);
    };
    quad({-width / 2, 0, 0}, {width, 0, 0}, {0, height, 0});
    quad({-width / 2, 0, 2}, {width, 0, 0}, {0, 0, -2});
    data.boundsMin = {-width / 2, 0, 0};
    data.boundsMax = {width / 2, height, 2};
    data.materials.resize(1);
    data.materials[0].baseColor = {0.55f, 0.5f, 0.44f, 1};
    data.ranges.push_back({0, uint32_t(data.indices.size()), 0});
    return data;
}

}  // namespace espalier::test
