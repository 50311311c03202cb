#pragma once

#include <string>

#include "runtime/gpu/functions.hpp"

namespace espalier {

// Why a driver is known to run Espalier's kernels wrongly, with what its user can do about it; empty: nothing is known
// against the driver. device: of an apiVersion of 1.3 or more.
std::string knownFault(const InstanceFunctions& vk, VkPhysicalDevice device);

}  // namespace espalier
