#pragma once

// Terminal meshes of roofs. Frame: x and y span the cell, 0 to 1, y up the slope; z out of the roof, metres (of boards
// and ridges in units of Shape's thickness).

#include "tools/content/model.hpp"

namespace espalier::content {

struct RoofMeshes {
    struct Entry {
        std::string name;  // KIND_lodN
        Mesh mesh;
        int material;      // 0 rough, 1 smooth, 2 glass
        float pixels = 0;  // as GlbMesh::pixels
    };
    std::vector<Entry> all;
};
RoofMeshes makeRoofMeshes();

}  // namespace espalier::content
