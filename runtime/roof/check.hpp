#pragma once

#include <string>

#include "runtime/roof/structure.hpp"

namespace espalier {

// What a house's faces break of the contract in structure.hpp; empty if nothing. Checked: indices; twins; closed
// chains; planes within 0.2 mm and 1e-5 of the house's size; slopes; monotone outlines that don't cross themselves; the
// faces' areas in plan make up the footprint's to 1e-6. Any thread. O(segments).
std::string checkRoof(const RoofStructure& structure, uint32_t house);

}  // namespace espalier
