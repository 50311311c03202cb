#pragma once

// Boxes around the inner texels of each tile of 8×8 of a level, around 2×2 of those, and so on to one: where to look
// for texels in a part of space. Object space. Read-only after it is built.

#include "runtime/surface/box_tree.hpp"
#include "runtime/surface/surface.hpp"

namespace espalier {

class TileBoxes {
  public:
    TileBoxes() = default;
    explicit TileBoxes(const SurfaceLevelData& level);

    enum class Part { none, some, all };
    // From the box of all down: of(box) tells how much of what is within is wanted, `some` where it is to ask about
    // parts. tile(number, all) for each tile that is left, in no order that matters. What has no inner texel isn't
    // asked about.
    template <class Of, class Tile>
    void visit(Of&& of, Tile&& tile) const {
        if (!sides_.empty()) descend(uint32_t(sides_.size()) - 1, 0, 0, false, of, tile);
    }

  private:
    struct Bounds {
        glm::vec3 low{1e30f}, high{-1e30f};
    };
    template <class Of, class Tile>
    void descend(uint32_t layer, uint32_t x, uint32_t y, bool all, Of& of, Tile& tile) const {
        const Bounds& b = boxes_[layer][size_t(y) * sides_[layer] + x];
        if (b.low.x > b.high.x) return;
        if (!all) {
            const Part part = of(Box{glm::dvec3(b.low), glm::dvec3(b.high)});
            if (part == Part::none) return;
            all = part == Part::all;
        }
        if (layer == 0) return tile(y * sides_[0] + x, all);
        for (uint32_t v = 2 * y; v < std::min(2 * y + 2, sides_[layer - 1]); ++v)
            for (uint32_t u = 2 * x; u < std::min(2 * x + 2, sides_[layer - 1]); ++u)
                descend(layer - 1, u, v, all, of, tile);
    }

    std::vector<uint32_t> sides_;             // per layer, of tiles or what stands for several
    std::vector<std::vector<Bounds>> boxes_;  // per layer, row by row
};

}  // namespace espalier
