#pragma once

// The stages of roofs, as a list.

#include "runtime/run/stage.hpp"
#include "shaders/shared/roof_records.h"

namespace espalier {

// What shaders ask for beside RoofEnv; as it is, nothing: of a list for native code alone.
struct RoofShaders {
    const Buffer *waves = nullptr, *status = nullptr;  // RoofEnv's: they hold numbers of groups
    std::vector<SpecConstant> constants;               // of derivation
    std::vector<Binding> derive, rows;
    uint64_t laneBytes = 0;  // of derivation
};

// Derives waves [first, last), then works out the rows of the grids that are new.
StageList roofStages(const RoofShaders& shaders, const RoofEnv& env, uint32_t first, uint32_t last);

}  // namespace espalier
