#pragma once

// Bodies for patterns to lie on: a cuirass, a vase and a knot. Closed, y up, standing on y = 0, metres.

#include "tools/content/model.hpp"

namespace espalier::content {

struct FormMeshes {
    struct Entry {
        std::string name;
        Mesh mesh;
    };
    std::vector<Entry> all;
};
FormMeshes makeForms();

}  // namespace espalier::content
