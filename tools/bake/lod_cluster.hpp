#pragma once

#include "tools/bake/bake_mesh.hpp"

namespace espalier::bakery {

// Moves the vertices of each cell of a grid into one place and returns what triangles are left then, as indices into
// `vertices`: fewer, none without extent. cell: side of the grid's cells, metres, at least 2⁻²⁰ of the bounds.
// materialOf: per vertex; every triangle keeps its own.
std::vector<uint32_t> clusterVertices(std::vector<DrawVertex>& vertices, const std::vector<uint32_t>& indices,
                                      const std::vector<uint32_t>& materialOf, float cell);

}  // namespace espalier::bakery
