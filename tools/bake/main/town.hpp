#pragma once

// espalier-bake's path for footprints: a town becomes a glTF binary, a node a house.

#include <string>
#include <vector>

#include "runtime/core/result.hpp"

namespace espalier {

struct TownArguments {
    std::string footprints, output;   // GeoJSON or a plan in metres (docs/roofs.md); .glb
    std::string grammar;              // empty: walls and roof planes only; else all that it makes, as triangles
    std::string meshes;               // roofs.glb; read with a grammar only
    bool walls = false;               // with a grammar: only walls, as ground for plants (town_walls.hpp)
    std::vector<std::string> houses;  // ids; empty: all
    bool quiet = false;
};

// Whether it is a file of footprints: .geojson, or .json that is no glTF.
bool isTown(const std::string& path);

// Writes the town, and its footprints in the extension ESPALIER_town. Features
// that can't be used are named on stderr; the rest of the town stands.
Status bakeTown(const TownArguments& arguments);

}  // namespace espalier
