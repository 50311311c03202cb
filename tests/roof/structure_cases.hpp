#pragma once

// Outlines to make roofs of: files of cases, and shapes of our own.

#include <string>
#include <vector>

#include "runtime/roof/footprint.hpp"

namespace espalier::test {

using Ring = std::vector<glm::dvec2>;

// {"buildings" or "cases": [{"id", "outer", "holes"}]}, as in the data folder's footprints. Empty, with a message,
// where the file isn't there.
std::vector<Footprint> casesOf(const std::string& file);

Footprint outline(std::string id, std::vector<Ring> rings);
// Letters about 10 m wide and some courtyards, at any size and turn.
std::vector<Footprint> letters();
Ring turned(const Ring& ring, double angle);

}  // namespace espalier::test
