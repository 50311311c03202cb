#pragma once

// What nodes have made, as hosts and tests want it: without the padding between rows.

#include "runtime/nodes/machine.hpp"

namespace espalier {

// Places before the part's program.
Result<std::vector<glm::vec3>> readPlaces(NodeMachine& machine, const GeometryPart& part);
// A word of each element, such as its octahedral normal or the bits of its size; none where there is no block.
Result<std::vector<uint32_t>> readWords(NodeMachine& machine, const GeometryPart& part, const BlockRef& block);
// Of triangles, by the numbers of readPlaces.
Result<std::vector<uint32_t>> readCorners(NodeMachine& machine, const GeometryPart& part);

}  // namespace espalier
