#pragma once

#include "runtime/roof/footprint.hpp"

namespace espalier {

// Puts footprints in degrees, or in metres of a plan, in metres about the town's origin, which it sets. Degrees: its
// middle, on either side of the antimeridian. A plan keeps its own origin unless the town lies more than 10 km from it;
// then whole metres near its middle are taken off, in doubles. What lies farther than 100 km from there is left out.
void placeTown(Town& town, bool geographic, const std::string& file);

}  // namespace espalier
