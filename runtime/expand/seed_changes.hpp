#pragma once

// Which seeds came, went or changed between two growths, and an edit's notes as kernels read them.

#include <optional>
#include <span>
#include <vector>

#include "runtime/expand/growth_data.hpp"

namespace espalier {

struct SeedChanges {
    bool any = false;               // else the indices are those of before
    std::vector<uint32_t> to;       // new index of each old seed, then of each frozen plant; kNoIndex: its plant goes
    std::vector<uint32_t> planted;  // indices of new seeds, and of those that changed
    std::vector<uint64_t> pruned;   // keys of branches that are cut away or grow again; ascending
};

// What a growth was made from, as far as the next one compares it.
struct GrownFrom {
    std::vector<Seed> seeds;
    std::vector<FrozenPlant> frozen;
    std::vector<uint64_t> pruned;
    std::vector<float> widths;
};

// Compares by key. A seed whose grammar's rules or width changed counts as another. Nothing: keys aren't unique, or a
// frozen plant has to be put in that putIn() hasn't.
std::optional<SeedChanges> seedChanges(const GrownFrom& before, const GrowthInputs& now);

// Keys as kernels read them: two words each.
std::vector<uint32_t> keyWords(std::span<const uint64_t> keys);

// AgainState::edits.
std::vector<uint32_t> editWords(const GrowthInputs& inputs, const SeedChanges& seeds);

}  // namespace espalier
