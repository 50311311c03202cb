#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "runtime/surface/surface.hpp"

namespace espalier {

// Boxes around the texels of each 8×8 block of a surface's finest level, and around 4×4 of those, to find what a dab
// may reach. Object space. Gutter texels count, empty ones don't.
class BlockBounds {
  public:
    BlockBounds() = default;
    explicit BlockBounds(const SurfaceLevelData& level);

    // Appends the blocks whose box the sphere meets.
    void near(glm::vec3 centre, float radius, std::vector<uint32_t>& blocks) const;

    uint32_t side() const { return side_; }  // blocks a side
    explicit operator bool() const { return side_ > 0; }

  private:
    struct Box {
        glm::vec3 low, high;  // low > high: nothing in it
    };
    static bool meets(const Box& box, glm::vec3 centre, float radius);

    uint32_t side_ = 0, tiles_ = 0;
    std::vector<Box> blockBoxes_, tileBoxes_;
};

}  // namespace espalier
