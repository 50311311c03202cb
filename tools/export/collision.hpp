#pragma once

// Meshes to collide with, without materials.

#include <string>
#include <vector>

#include "tools/export/export.hpp"
#include "tools/export/gltf_file.hpp"

namespace espalier::exporting {

// A mesh for each plant's stems, each house, and all pieces, of the coarsest levels there are; leaves let everything
// through. Returns their nodes, of names like "stems_1_collision".
std::vector<size_t> addCollision(const Gathered& gathered, GltfFile& file);

}  // namespace espalier::exporting
