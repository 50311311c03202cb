// In: the seeds of two growths, notes of an edit. Out: the difference by key; words for the kernel that finds what
// the edit concerns (expand_again.h).
#include "runtime/expand/seed_changes.hpp"

#include <algorithm>
#include <cstring>
#include <iterator>
#include <unordered_map>

#include "shaders/shared/expand_again.h"

namespace espalier {
namespace {

// The coarser grids of a finest one.
void addLevels(std::vector<uint32_t>& grid) {
    for (uint32_t level = 0; level < kMaxReadLevel; ++level) {
        const uint32_t side = kLayerTiles >> level, from = dirtyGrid(level), to = dirtyGrid(level + 1);
        for (uint32_t bit = 0; bit < side * side; ++bit) {
            if (bit % 32 == 0 && grid[from + bit / 32] == 0) bit += 31;
            if ((grid[from + bit / 32] >> (bit % 32) & 1) == 0) continue;
            const uint32_t above = bit / side / 2 * (side / 2) + bit % side / 2;
            grid[to + above / 32] |= 1u << (above % 32);
        }
    }
}

}  // namespace

std::optional<SeedChanges> seedChanges(std::span<const Seed> before, std::span<const Seed> now,
                                       const GrowthChanges& changes, std::span<const float> widthsBefore,
                                       std::span<const float> widthsNow) {
    SeedChanges out;
    const auto other = [&](uint32_t grammar) {
        const bool ruled =
            std::find(changes.grammars.begin(), changes.grammars.end(), grammar) != changes.grammars.end();
        const float was = grammar < widthsBefore.size() ? widthsBefore[grammar] : 0;
        return ruled || was != (grammar < widthsNow.size() ? widthsNow[grammar] : 0);
    };
    bool anyOther = false;
    for (uint32_t g = 0; g < std::max(widthsBefore.size(), widthsNow.size()); ++g) anyOther = anyOther || other(g);
    if (changes.grammars.empty() && !anyOther && before.size() == now.size() &&
        (now.empty() || std::memcmp(before.data(), now.data(), now.size_bytes()) == 0))
        return out;

    std::unordered_map<uint64_t, uint32_t> indices;
    for (uint32_t i = 0; i < now.size(); ++i)
        if (!indices.emplace(now[i].key, i).second) return std::nullopt;
    out.any = true;
    out.to.assign(before.size(), kNoIndex);
    std::vector<bool> stays(now.size(), false);
    for (uint32_t i = 0; i < before.size(); ++i) {
        const auto found = indices.find(before[i].key);
        if (found == indices.end() || stays[found->second]) continue;
        if (std::memcmp(&before[i], &now[found->second], sizeof(Seed)) != 0 || other(before[i].grammar)) continue;
        out.to[i] = found->second;
        stays[found->second] = true;
    }
    for (uint32_t i = 0; i < now.size(); ++i)
        if (!stays[i]) out.planted.push_back(i);
    return out;
}

std::vector<uint64_t> prunedChanges(std::span<const uint64_t> before, std::span<const uint64_t> now) {
    std::vector<uint64_t> changed;
    std::set_symmetric_difference(before.begin(), before.end(), now.begin(), now.end(), std::back_inserter(changed));
    return changed;
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
    std::vector<uint32_t> words(kEditHead);
    if (seeds.any && !seeds.to.empty()) {
        words[kEditSeeds] = uint32_t(words.size());
        words.insert(words.end(), seeds.to.begin(), seeds.to.end());
    }
    const GrowthChanges& changes = *inputs.changes;
    if (!changes.params.empty()) {
        words[kEditParams] = uint32_t(words.size());
        words.resize(words.size() + inputs.grammars.size());
        for (const auto& [grammar, slots] : changes.params)
            if (grammar < inputs.grammars.size()) words[words[kEditParams] + grammar] |= slots;
    }
    if (!seeds.pruned.empty()) {
        words[kEditPruned] = uint32_t(words.size());
        words.push_back(uint32_t(seeds.pruned.size()));
        const std::vector<uint32_t> keys = keyWords(seeds.pruned);
        words.insert(words.end(), keys.begin(), keys.end());
    }
    // One grid an instance for all of its layers.
    for (uint32_t instance = 0; instance < 256; ++instance) {
        std::vector<uint32_t> grid;
        for (const DirtyTiles& dirty : changes.tiles) {
            if (dirty.instance != instance) continue;
            words[kEditLayers] |= 1u << dirty.layer % kMaxLayers;
            grid.resize(dirtyGrid(kMaxReadLevel + 1));
            for (size_t i = 0; i < dirty.bits.size() * 2; ++i) grid[i] |= uint32_t(dirty.bits[i / 2] >> (i % 2 * 32));
        }
        if (grid.empty()) continue;
        addLevels(grid);
        words[kEditInstances + instance] = uint32_t(words.size());
        words.insert(words.end(), grid.begin(), grid.end());
    }
    return words;
}

}  // namespace espalier
