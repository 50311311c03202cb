// In: a level's texels. Out: the boxes around its tiles, and those around the boxes.
#include "runtime/surface/tile_boxes.hpp"

namespace espalier {

TileBoxes::TileBoxes(const SurfaceLevelData& level) {
    const uint32_t side = level.size / 8;
    sides_.push_back(side);
    boxes_.emplace_back(size_t(side) * side);
    for (size_t i = 0; i < level.texels.size(); ++i) {
        if (texelClass(level.texels[i].bits) != kTexelInner) continue;
        Bounds& b = boxes_[0][i >> 6];
        b.low = glm::min(b.low, level.texels[i].position), b.high = glm::max(b.high, level.texels[i].position);
    }
    while (sides_.back() > 1) {
        const uint32_t from = sides_.back(), to = (from + 1) / 2;
        std::vector<Bounds> layer(size_t(to) * to);
        for (uint32_t y = 0; y < from; ++y)
            for (uint32_t x = 0; x < from; ++x) {
                const Bounds& b = boxes_.back()[size_t(y) * from + x];
                Bounds& all = layer[size_t(y / 2) * to + x / 2];
                all.low = glm::min(all.low, b.low), all.high = glm::max(all.high, b.high);
            }
        sides_.push_back(to);
        boxes_.push_back(std::move(layer));
    }
}

}  // namespace espalier
