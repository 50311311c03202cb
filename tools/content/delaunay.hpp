#pragma once

// Delaunay triangulation in the plane, for the content tool's planar charts.

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

namespace espalier::content {

// Counter-clockwise triangles over `points` (distinct, at least 3). Points are moved by about 1e-7 of the extent
// inside the predicates so that regular grids need no special case; a triangle may thus be degenerate where
// three points are collinear on the outside.
std::vector<std::array<uint32_t, 3>> delaunay(const std::vector<glm::dvec2>& points);

// True where p lies inside the closed loops by the even-odd rule.
bool insideLoops(const std::vector<std::vector<glm::dvec2>>& loops, glm::dvec2 p);

}  // namespace espalier::content
