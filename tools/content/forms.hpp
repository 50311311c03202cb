#pragma once

// Bodies for patterns to lie on: a cuirass, a vase, a knot, a pear, a torus and three tori that run through each other
// (a surface of genus 7), which are closed; and a plane of 2 m, which has a front only. y up, standing on y = 0,
// metres.

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
// The three tori alone, by a way of their own.
Mesh makeLinkedTori();

}  // namespace espalier::content
