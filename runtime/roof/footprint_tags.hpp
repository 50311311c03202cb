#pragma once

#include <string>
#include <vector>

#include "runtime/roof/footprint.hpp"
#include "runtime/roof/footprint_properties.hpp"

namespace espalier {

// Takes what OpenStreetMap's Simple 3D Buildings tags say into the footprint. Values are numbers
// or strings ("12", "12.5 m", "40 ft"). What can't be meant (negative heights, unknown shapes) becomes a warning and is
// left at its default.
void applyTags(const FeatureTags& tags, const std::string& file, Footprint& footprint,
               std::vector<Diagnostic>& diagnostics);

// Warns of roof: keys that aren't known: once a feature, however many polygons it has.
void tellUnknownTags(const FeatureTags& tags, const std::string& file, const std::string& id,
                     std::vector<Diagnostic>& diagnostics);

}  // namespace espalier
