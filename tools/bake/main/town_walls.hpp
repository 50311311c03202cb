#pragma once

// The walls of a town's houses as ground for plants: without what a grammar sets into them.

#include "runtime/emit/roof_triangles.hpp"

namespace espalier {

// Walls of one house from foot to a little below eaves and verges, a centimetre before the plaster. Where upright
// terminals of `grids` (indices into env's, all of this house) stand out from the wall there is none: windows,
// shutters, doors; but a board along the whole foot, a plinth, is gone around.
void appendWalls(const RoofEnv& env, const std::vector<uint32_t>& grids, const RoofStructure& structure, uint32_t house,
                 RoofTriangles& out);

}  // namespace espalier
