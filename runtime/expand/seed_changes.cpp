// In: the seeds of two growths, notes of an edit. Out: the difference by key; words for the kernel that finds what
// the edit concerns (expand_again.h).
#include "runtime/expand/seed_changes.hpp"

#include <algorithm>
#include <cstring>
#include <iterator>
#include <unordered_map>
#include <unordered_set>

#include "shaders/shared/expand_again.h"

namespace espalier {
namespace {

// Cells within one of a marked one: whole ones that hold all reads of its texels.
std::vector<uint32_t> readersOf(const std::vector<uint32_t>& cells) {
    constexpr uint32_t kRow = kLayerCells / 32;
    std::vector<uint32_t> wide(cells), readers(cells.size());
    for (uint32_t i = 0; i < cells.size(); ++i) {
        wide[i] |= cells[i] << 1 | cells[i] >> 1;
        if (i % kRow > 0) wide[i] |= cells[i - 1] >> 31;
        if (i % kRow + 1 < kRow) wide[i] |= cells[i + 1] << 31;
    }
    for (uint32_t i = 0; i < cells.size(); ++i) {
        readers[i] = wide[i];
        if (i >= kRow) readers[i] |= wide[i - kRow];
        if (i + kRow < cells.size()) readers[i] |= wide[i + kRow];
    }
    return readers;
}

// Grids of tiles, the finest first, and the cells, from these.
std::vector<uint32_t> gridsOf(const std::vector<uint32_t>& cells) {
    std::vector<uint32_t> grid(dirtyGrid(kMaxReadLevel + 1));
    const auto add = [&](const uint32_t* from, uint32_t side, uint32_t shrink, uint32_t* to) {
        const uint32_t leftmost = 0xFFFFFFFF / ((1u << shrink) - 1);  // of each `shrink` bits of a row
        for (uint32_t word = 0; word < (side * side + 31) / 32; ++word) {
            uint32_t bits = from[word];
            for (uint32_t far = 1; far < shrink; far *= 2) bits |= bits >> far;
            for (bits &= leftmost; bits != 0; bits &= bits - 1) {
                const uint32_t bit = word * 32 + lowestBit(bits);
                const uint32_t above = bit / side / shrink * (side / shrink) + bit % side / shrink;
                to[above / 32] |= 1u << (above % 32);
            }
        }
    };
    add(readersOf(cells).data(), kLayerCells, kLayerCells / kLayerTiles, grid.data());
    for (uint32_t level = 0; level < kMaxReadLevel; ++level)
        add(&grid[dirtyGrid(level)], kLayerTiles >> level, 2, &grid[dirtyGrid(level + 1)]);
    grid.insert(grid.end(), cells.begin(), cells.end());
    return grid;
}

// The box around the finest grid's tiles, as find reads it.
uint32_t boxOf(const std::vector<uint32_t>& grid) {
    uint32_t x0 = kLayerTiles - 1, y0 = x0, x1 = 0, y1 = 0;
    for (uint32_t bit = 0; bit < kLayerTiles * kLayerTiles; ++bit) {
        if (bit % 32 == 0 && grid[bit / 32] == 0) bit += 31;
        if ((grid[bit / 32] >> (bit % 32) & 1) == 0) continue;
        x0 = std::min(x0, bit % kLayerTiles), x1 = std::max(x1, bit % kLayerTiles);
        y0 = std::min(y0, bit / kLayerTiles), y1 = bit / kLayerTiles;
    }
    return x0 | y0 << 8 | x1 << 16 | y1 << 24;
}

bool sameFrozen(std::span<const FrozenPlant> a, std::span<const FrozenPlant> b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const FrozenPlant& x, const FrozenPlant& y) {
        return x.key == y.key && x.records == y.records;
    });
}

bool sameSeeds(std::span<const Seed> a, std::span<const Seed> b) {
    return a.size() == b.size() && (b.empty() || std::memcmp(a.data(), b.data(), b.size_bytes()) == 0);
}

}  // namespace

std::optional<SeedChanges> seedChanges(const GrownFrom& before, const GrowthInputs& now) {
    SeedChanges out;
    std::set_symmetric_difference(before.pruned.begin(), before.pruned.end(), now.pruned.begin(), now.pruned.end(),
                                  std::back_inserter(out.pruned));
    const auto other = [&](uint32_t grammar) {
        const std::vector<uint32_t>& ruled = now.changes->grammars;
        const float was = grammar < before.widths.size() ? before.widths[grammar] : 0;
        return std::find(ruled.begin(), ruled.end(), grammar) != ruled.end() ||
               was != (grammar < now.widths.size() ? now.widths[grammar] : 0);
    };
    bool anyOther = !now.changes->grammars.empty();
    for (uint32_t g = 0; g < std::max(before.widths.size(), now.widths.size()); ++g) anyOther = anyOther || other(g);
    if (!anyOther && now.changes->seeds.empty() && now.changes->frozen.empty() && sameSeeds(before.seeds, now.seeds) &&
        sameFrozen(before.frozen, now.frozen))
        return out;

    const auto setOf = [](const std::vector<uint64_t>& keys) {
        return std::unordered_set<uint64_t>(keys.begin(), keys.end());
    };
    const std::unordered_set<uint64_t> anew = setOf(now.changes->seeds), putIn = setOf(now.changes->frozen);
    std::unordered_map<uint64_t, uint32_t> indices;
    const uint32_t seeds = uint32_t(now.seeds.size()), all = seeds + uint32_t(now.frozen.size());
    for (uint32_t i = 0; i < all; ++i)
        if (!indices.emplace(i < seeds ? now.seeds[i].key : now.frozen[i - seeds].key, i).second) return std::nullopt;
    out.any = true;
    std::vector<bool> stays(all, false);
    // `plant`: null for one that isn't frozen yet.
    const auto follow = [&](uint64_t key, const Seed* seed, const FrozenPlant* plant) {
        const auto found = indices.find(key);
        bool same = found != indices.end() && !stays[found->second];
        if (same && found->second < seeds)
            same = seed && !anew.contains(key) && std::memcmp(seed, &now.seeds[found->second], sizeof(Seed)) == 0 &&
                   !other(seed->grammar);
        else if (same && plant)
            same = plant->records == now.frozen[found->second - seeds].records;
        else if (same)
            same = !putIn.contains(key);
        if (same) stays[found->second] = true;
        out.to.push_back(same ? found->second : kNoIndex);
    };
    for (const Seed& seed : before.seeds) follow(seed.key, &seed, nullptr);
    for (const FrozenPlant& plant : before.frozen) follow(plant.key, nullptr, &plant);
    for (uint32_t i = 0; i < seeds; ++i)
        if (!stays[i]) out.planted.push_back(i);
    if (std::find(stays.begin() + seeds, stays.end(), false) != stays.end()) return std::nullopt;
    return out;
}

std::vector<uint32_t> keyWords(std::span<const uint64_t> keys) {
    std::vector<uint32_t> words;
    for (uint64_t key : keys) {
        words.push_back(uint32_t(key));
        words.push_back(uint32_t(key >> 32));
    }
    return words;
}

std::vector<uint32_t> editWords(const GrowthInputs& inputs, const SeedChanges& seeds) {
    const GrowthChanges& changes = *inputs.changes;
    uint32_t instances = 0;
    for (const DirtyCells& dirty : changes.cells) instances = std::max(instances, dirty.instance + 1);
    std::vector<uint32_t> words(kEditHead + instances);
    words[kEditInstances] = instances;
    if (seeds.any && !seeds.to.empty()) {
        words[kEditSeeds] = uint32_t(words.size());
        words.insert(words.end(), seeds.to.begin(), seeds.to.end());
    }
    if (!changes.uses.empty()) {
        words[kEditUses] = uint32_t(words.size());
        words.resize(words.size() + inputs.grammars.size());
        for (const auto& [grammar, bits] : changes.uses)
            if (grammar < inputs.grammars.size()) words[words[kEditUses] + grammar] |= bits;
    }
    if (!changes.extrudes.empty()) {
        words[kEditExtrudes] = uint32_t(words.size());
        words.resize(words.size() + inputs.grammars.size());
        for (uint32_t grammar : changes.extrudes)
            if (grammar < inputs.grammars.size()) words[words[kEditExtrudes] + grammar] = 1;
    }
    if (!seeds.pruned.empty()) {
        words[kEditPruned] = uint32_t(words.size());
        words.push_back(uint32_t(seeds.pruned.size()));
        const std::vector<uint32_t> keys = keyWords(seeds.pruned);
        words.insert(words.end(), keys.begin(), keys.end());
    }
    // One grid an instance for all of its layers.
    for (uint32_t instance = 0; instance < instances; ++instance) {
        std::vector<uint32_t> cells;
        for (const DirtyCells& dirty : changes.cells) {
            if (dirty.instance != instance) continue;
            words[kEditLayers] |= 1u << dirty.layer % kMaxLayers;
            cells.resize(kCellWords);
            for (uint32_t i = 0; i < kCellWords; ++i) cells[i] |= dirty.bits[i];
        }
        if (cells.empty()) continue;
        const std::vector<uint32_t> grid = gridsOf(cells);
        words.push_back(boxOf(grid));
        words[kEditGrids + instance] = uint32_t(words.size());
        words.insert(words.end(), grid.begin(), grid.end());
    }
    return words;
}

}  // namespace espalier
