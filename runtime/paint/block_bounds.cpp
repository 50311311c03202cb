// In: the texels of a surface's finest level. Out: which blocks of them lie near a point.
#include "runtime/paint/block_bounds.hpp"

#include <limits>

#include "runtime/core/jobs.hpp"

namespace espalier {
namespace {

constexpr uint32_t kTileBlocks = 4;  // a side

}  // namespace

BlockBounds::BlockBounds(const SurfaceLevelData& level) : side_(level.size / 8) {
    const glm::vec3 none(std::numeric_limits<float>::infinity());
    blockBoxes_.assign(size_t(side_) * side_, {none, -none});
    parallelFor(blockBoxes_.size(), 256, [&](size_t begin, size_t end) {
        for (size_t b = begin; b < end; ++b)
            for (size_t i = b * 64; i < b * 64 + 64; ++i) {
                const Texel& texel = level.texels[i];
                if (texelClass(texel.bits) == kTexelEmpty) continue;
                blockBoxes_[b].low = glm::min(blockBoxes_[b].low, texel.position);
                blockBoxes_[b].high = glm::max(blockBoxes_[b].high, texel.position);
            }
    });
    tiles_ = (side_ + kTileBlocks - 1) / kTileBlocks;
    tileBoxes_.assign(size_t(tiles_) * tiles_, {none, -none});
    for (uint32_t y = 0; y < side_; ++y)
        for (uint32_t x = 0; x < side_; ++x) {
            Box& tile = tileBoxes_[size_t(y / kTileBlocks) * tiles_ + x / kTileBlocks];
            const Box& block = blockBoxes_[size_t(y) * side_ + x];
            tile.low = glm::min(tile.low, block.low);
            tile.high = glm::max(tile.high, block.high);
        }
}

bool BlockBounds::meets(const Box& box, glm::vec3 centre, float radius) {
    const glm::vec3 gap = glm::max(glm::max(box.low - centre, centre - box.high), glm::vec3(0));
    return box.low.x <= box.high.x && glm::dot(gap, gap) <= radius * radius;
}

void BlockBounds::near(glm::vec3 centre, float radius, std::vector<uint32_t>& blocks) const {
    for (uint32_t t = 0; t < tileBoxes_.size(); ++t) {
        if (!meets(tileBoxes_[t], centre, radius)) continue;
        const uint32_t x0 = t % tiles_ * kTileBlocks, y0 = t / tiles_ * kTileBlocks;
        for (uint32_t y = y0; y < std::min(y0 + kTileBlocks, side_); ++y)
            for (uint32_t x = x0; x < std::min(x0 + kTileBlocks, side_); ++x)
                if (meets(blockBoxes_[size_t(y) * side_ + x], centre, radius)) blocks.push_back(y * side_ + x);
    }
}

}  // namespace espalier
