// Notes of edits, gathered until the next growth.
#include "runtime/expand/changes.hpp"

#include <algorithm>
#include <cmath>

namespace espalier {

void GrowthChanges::markTexels(uint32_t instance, uint32_t layer, uint32_t size, uint32_t x0, uint32_t y0, uint32_t x1,
                               uint32_t y1) {
    if (x0 >= x1 || y0 >= y1 || size == 0) return;
    auto found = std::find_if(cells.begin(), cells.end(),
                              [&](const DirtyCells& c) { return c.instance == instance && c.layer == layer; });
    if (found == cells.end()) {
        found = cells.emplace(cells.end());
        found->instance = instance;
        found->layer = layer;
    }
    // A read takes in texels that are less than half a texel away. Where that is more than half a cell, which who looks
    // at cells allows for (kCellReach), the rest is marked.
    const double each = double(kLayerCells) / size, rest = std::max(0.0, 0.5 * each - 0.5);
    const auto first = [&](uint32_t t) { return uint32_t(std::max(0.0, std::floor(t * each - rest))); };
    const auto end = [&](uint32_t t) { return uint32_t(std::min<double>(kLayerCells, std::ceil(t * each + rest))); };
    for (uint32_t y = first(y0); y < end(y1); ++y)
        for (uint32_t x = first(x0); x < end(x1); ++x) found->bits[(y * kLayerCells + x) / 32] |= 1u << (x % 32);
}

void GrowthChanges::markUses(uint32_t grammar, uint32_t mask) {
    if (mask == 0) return;
    for (auto& [known, bits] : uses)
        if (known == grammar) {
            bits |= mask;
            return;
        }
    uses.emplace_back(grammar, mask);
}

}  // namespace espalier
