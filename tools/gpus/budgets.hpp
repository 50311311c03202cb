#pragma once

// How much of a GPU a kernel may take.

#include <string_view>

#include "tools/gpus/null_device.hpp"

namespace espalier {

struct Budget {
    uint32_t spilled = 0;       // registers, vector and scalar together
    uint32_t scratchBytes = 0;  // of a lane
    uint32_t subgroups = 0;     // at least so many fit on a SIMD unit
};

// Of a kernel (its path below shaders/) on a chip.
Budget budgetOf(std::string_view chip, std::string_view kernel);
bool within(const KernelCost& cost, const Budget& budget);

}  // namespace espalier
