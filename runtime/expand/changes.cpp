// Notes of edits, gathered until the next growth.
#include "runtime/expand/changes.hpp"

#include <algorithm>

namespace espalier {

void GrowthChanges::markTiles(uint32_t instance, uint32_t layer, uint32_t size, uint32_t x0, uint32_t y0, uint32_t x1,
                              uint32_t y1) {
    if (x0 >= x1 || y0 >= y1 || size == 0) return;
    auto found = std::find_if(tiles.begin(), tiles.end(),
                              [&](const DirtyTiles& t) { return t.instance == instance && t.layer == layer; });
    if (found == tiles.end()) {
        found = tiles.emplace(tiles.end());
        found->instance = instance;
        found->layer = layer;
    }
    // A read takes in the next texel to any side, and nodes keep rounded coordinates.
    constexpr uint64_t kReach = 2;
    const auto first = [&](uint64_t t) { return (t - std::min(t, kReach)) * kLayerTiles / size; };
    const auto end = [&](uint64_t t) {
        return std::min<uint64_t>(((t + kReach) * kLayerTiles + size - 1) / size, kLayerTiles);
    };
    for (uint64_t y = first(y0); y < end(y1); ++y)
        for (uint64_t x = first(x0); x < end(x1); ++x) found->bits[(y * kLayerTiles + x) / 64] |= 1ull << (x % 64);
}

void GrowthChanges::markParams(uint32_t grammar, uint32_t mask) {
    if (mask == 0) return;
    for (auto& [known, slots] : params)
        if (known == grammar) {
            slots |= mask;
            return;
        }
    params.emplace_back(grammar, mask);
}

}  // namespace espalier
