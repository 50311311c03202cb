#pragma once

// Texts of Function nodes: an expression for each of x, y and z becomes a program (shaders/shared/node_function.h).

#include <array>
#include <string>

#include "runtime/core/result.hpp"

namespace espalier {

// In: expressions of x, y, z, a, b, c. Out: words. A failure tells which expression, at which column, and what is
// wrong.
Result<std::vector<uint32_t>> compileFunction(const std::array<std::string, 3>& texts);

}  // namespace espalier
