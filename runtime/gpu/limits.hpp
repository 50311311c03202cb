#pragma once

#include <cstdint>

namespace espalier {

// Bytes of the largest uniform block that is bound: growth's and roofs' tables lie in one. Devices that hold less are
// refused.
constexpr uint32_t kUniformBytes = 65536;

}  // namespace espalier
