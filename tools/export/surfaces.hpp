#pragma once

// The models that growth stands on, out of the files that espalier-bake wrote.

#include <string>
#include <vector>

#include "tools/export/export.hpp"
#include "tools/export/gltf_file.hpp"

namespace espalier::exporting {

// Adds the drawn mesh of each with its materials and pictures, as packed as it is in its file, and a node where it
// stands. False: `error` names the file and the cause.
bool addSurfaces(const std::vector<ExportSurface>& surfaces, GltfFile& file, std::vector<size_t>& nodes,
                 std::string& error);

}  // namespace espalier::exporting
