#pragma once

#include <string_view>

#include "runtime/core/result.hpp"
#include "runtime/gpu/functions.hpp"

namespace espalier {

// What a VkResult other than VK_SUCCESS means, as a failure: of memory, of the device's loss, or else of the driver,
// with the result's name. what: what the call was for, "making a buffer".
Failure resultFailure(VkResult result, std::string_view object, std::string_view what);

}  // namespace espalier
