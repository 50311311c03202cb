#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "runtime/roof/footprint.hpp"

namespace espalier {

// Takes what OpenStreetMap's Simple 3D Buildings tags say into the footprint. `tags` is a JSON object; values are
// numbers or strings ("12", "12.5 m"). What can't be meant (negative heights, unknown shapes) becomes a warning and is
// left at its default.
void applyTags(const nlohmann::json& tags, const std::string& file, Footprint& footprint,
               std::vector<Diagnostic>& diagnostics);

// Warns of roof: keys that aren't known: once a feature, however many polygons it has.
void tellUnknownTags(const nlohmann::json& tags, const std::string& file, const std::string& id,
                     std::vector<Diagnostic>& diagnostics);

}  // namespace espalier
