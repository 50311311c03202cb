#pragma once

#include <optional>
#include <vector>

#include "runtime/roof/structure_facets.hpp"

namespace espalier {

// One plane over the whole outline, falling to the edge that faces `direction` (radians clockwise from north) best, or
// to the longest edge, and walls up to it. The plane's facet is neither cut nor free of holes yet.
Facets shedFacets(const std::vector<std::vector<glm::dvec2>>& rings, std::optional<double> direction, double slope);

}  // namespace espalier
