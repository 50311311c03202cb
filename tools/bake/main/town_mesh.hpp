#pragma once

// A town's walls and roof planes as triangles in memory.

#include "runtime/emit/roof_triangles.hpp"

namespace espalier {

inline constexpr uint32_t kWallColour = 0xFF8FB0C4;  // of a vertex: 8 bits each, red lowest

// Walls and roof planes of one house, watertight but for its foot.
void appendMassing(const RoofStructure& structure, uint32_t house, RoofTriangles& out);

}  // namespace espalier
