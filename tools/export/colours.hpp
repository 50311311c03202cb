#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "plugin_api/espalier.h"

namespace espalier::exporting {

// Instances that share a colour, which in glTF is a material's.
struct ColourGroup {
    std::array<float, 3> colour{};  // linear, their mean
    std::vector<uint32_t> instances;
};

// Into at most `most` groups, each as alike as that allows.
std::vector<ColourGroup> groupedByColour(const std::vector<EspPartInstance>& instances, size_t most);

}  // namespace espalier::exporting
