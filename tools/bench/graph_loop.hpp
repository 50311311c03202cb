#pragma once

// The woven sphere as one would write it by hand: the other side of graph/woven.

#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

namespace espalier {

struct WovenLoop {
    uint32_t points, curves, keys, samples, sides;
    std::vector<glm::vec3> particles, velocities;
    std::vector<uint32_t> subsets;  // [curve * keys + key]
    std::vector<glm::vec3> ring, path, vertices;
    std::vector<uint32_t> normals;  // octahedral

    WovenLoop(uint32_t points, uint32_t curves, uint32_t samples, uint32_t sides);
    // Particles go one step, and all is made from them.
    void step();
};

}  // namespace espalier
