#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "runtime/roof/structure_facets.hpp"

namespace espalier {

// The edge to which a shed falls: `lowEdge`, else the one that faces `direction` (radians clockwise from north) best,
// else the longest, of those that `kept` doesn't hold; of those that face alike the outermost.
uint32_t shedEave(const std::vector<std::vector<glm::dvec2>>& rings, std::optional<uint32_t> lowEdge,
                  std::optional<double> direction, const std::vector<bool>& kept);

// One plane over the whole outline, falling to the eave, and walls up to it. The plane's facet is neither cut nor free
// of holes yet.
Facets shedFacets(const std::vector<std::vector<glm::dvec2>>& rings, uint32_t eave, double slope);

}  // namespace espalier
