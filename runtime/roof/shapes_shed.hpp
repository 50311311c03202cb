#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "runtime/roof/structure_facets.hpp"

namespace espalier {

// One plane over the whole outline, falling to `lowEdge`, else to the one that faces `direction` (radians clockwise
// from north) best, else to the longest edge, and walls up to it. The plane's facet is neither cut nor free of holes
// yet.
Facets shedFacets(const std::vector<std::vector<glm::dvec2>>& rings, std::optional<uint32_t> lowEdge,
                  std::optional<double> direction, double slope);

}  // namespace espalier
