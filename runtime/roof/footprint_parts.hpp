#pragma once

#include "runtime/roof/footprint.hpp"

namespace espalier {

// Leaves out outlines whose parts stand for them (Simple 3D Buildings, building:part): those of which parts with a
// point inside cover at least nine tenths. A file in which too many overlap keeps all, and a diagnostic says so.
void leaveOutlinesToParts(Town& town);

}  // namespace espalier
