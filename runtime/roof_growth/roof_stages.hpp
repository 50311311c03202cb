#pragma once

// The stages of roofs, as a list.

#include "runtime/run/stage.hpp"
#include "shaders/shared/roof_records.h"

namespace espalier {

// What shaders ask for beside RoofEnv; as it is, nothing: of a list for native code alone.
struct RoofShaders {
    const Buffer* waves = nullptr;  // RoofEnv's: they hold numbers of groups
    std::vector<SpecConstant> constants;
    std::vector<Binding> bindings[2];  // of even waves and of odd ones
};

// Derives waves [first, last). env.shapes: of even waves; env.next: of odd ones.
StageList roofStages(const RoofShaders& shaders, const RoofEnv& env, uint32_t first, uint32_t last);

}  // namespace espalier
