#pragma once

#include <string>
#include <vector>

#include "tools/scene/folder.hpp"

namespace espalier::document {

// The folders in a project's.
inline constexpr const char* kLayers = "layers";
inline constexpr const char* kPlants = "plants";
inline constexpr const char* kSurfaces = "surfaces";

// Removes what interrupted saves have left behind, and layers, plants and bakes that no text in the project's folder
// names, but for `kept`. Where a text can't be read, nothing is removed. A link in place of one of the folders is left
// alone, and so is all that it leads to. The caller holds the folder's WriteLock.
void sweepProject(const scene::Folder& home, const std::vector<std::string>& kept);

}  // namespace espalier::document
