#pragma once

// From footprints to roof structures.

#include "runtime/roof/footprint.hpp"
#include "runtime/roof/structure.hpp"

namespace espalier {

// Appends the footprint's house to the structure: more than one where its outline falls apart, none where it can't be
// used. What is appended has passed checkRoof(); what has not is redone in higher precision, then as a hip, then left
// out. Diagnostics name the footprint's id as rule. Any thread, one structure a thread.
// Returns whether a house was appended.
bool appendRoof(const Footprint& footprint, RoofStructure& out, std::vector<Diagnostic>& diagnostics);

// All of a town, in its order, on all cores.
RoofStructure roofsOf(const std::vector<Footprint>& footprints, std::vector<Diagnostic>& diagnostics);
RoofStructure roofOf(const Footprint& footprint, std::vector<Diagnostic>& diagnostics);

}  // namespace espalier
