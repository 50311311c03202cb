#pragma once

#include "runtime/roof/footprint.hpp"

namespace espalier {

// Tells footprints of each other: walls that two share, where neither roof may hang over nor windows look out
// (Footprint::shared), and parts without a roof:shape on which another part stands, whose roof is flat. Walls count as
// shared where they face each other within 0.3 m over at least half a metre. In a file in which too many lie over each
// other nothing is told, and a diagnostic says so.
void findNeighbours(Town& town);

}  // namespace espalier
