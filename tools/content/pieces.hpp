#pragma once

// Pieces that patterns are made of. Each fills the box of a scope of size 1: x and z from -0.5 to 0.5, y from 0 up,
// where y leads off the surface and x is the scope's own x axis; bodies that are the same all around have their middle
// at the origin. Texture coordinate u is how bright the mesh leaves its colour.

#include "tools/content/model.hpp"

namespace espalier::content {

struct PieceMeshes {
    struct Entry {
        std::string name;  // KIND_lodN
        Mesh mesh;
        int material;  // 0 rough, 1 smooth
    };
    std::vector<Entry> all;
};
PieceMeshes makePieceMeshes();

}  // namespace espalier::content
