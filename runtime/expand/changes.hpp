#pragma once

// What changed since the last growth, so that only what depends on it is grown again. Whoever edits an input of
// growth notes it here; seeds are compared by key and need no note.

#include <cstdint>
#include <utility>
#include <vector>

#include "shaders/shared/growth_records.h"

namespace espalier {

// Cells of one layer of one surface instance where texels have changed: a bilinear read may have changed that is no
// farther than kCellReach from one. They cover its UV, whatever size it has.
struct DirtyCells {
    uint32_t instance = 0, layer = 0;  // layer: the scene's number, below kMaxLayers
    std::vector<uint32_t> bits = std::vector<uint32_t>(kLayerCells * kLayerCells / 32);  // bit y * kLayerCells + x
};

struct GrowthChanges {
    bool everything = true;  // limits, what isn't known: all is grown anew
    std::vector<DirtyCells> cells;
    std::vector<std::pair<uint32_t, uint32_t>> uses;  // grammar's index, what of it has changed, as Chunk::uses
    std::vector<uint32_t> grammars;                   // indices of those whose plants grow anew
    std::vector<uint32_t> extrudes{};                 // of those that draw something else on spans
    std::vector<uint64_t> seeds{};                    // keys of seeds whose plants grow anew: their ground is another
    std::vector<uint64_t> frozen{};  // keys of frozen plants that aren't what grew there: their records are put in

    // Texels [x0, x1) × [y0, y1) of a layer of `size` texels a side have other values. All of them, when a layer comes,
    // goes or changes its size.
    void markTexels(uint32_t instance, uint32_t layer, uint32_t size, uint32_t x0, uint32_t y0, uint32_t x1,
                    uint32_t y1);
    void markLayer(uint32_t instance, uint32_t layer, uint32_t size) {
        markTexels(instance, layer, size, 0, 0, size, size);
    }
    void markUses(uint32_t grammar, uint32_t mask);
    bool none() const {
        return !everything && cells.empty() && uses.empty() && grammars.empty() && extrudes.empty() && seeds.empty() &&
               frozen.empty();
    }
};

}  // namespace espalier
