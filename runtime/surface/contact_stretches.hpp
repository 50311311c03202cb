#pragma once

// Along which stretches meshes touch: what pairs of triangles find, joined where they lie on one edge.

#include <vector>

#include "runtime/surface/contact_segments.hpp"
#include "runtime/surface/contacts.hpp"

namespace espalier {

// One mesh of a search: where its points are in the space of the search, side 0's object space.
struct ContactView {
    const ContactMesh& mesh;
    glm::dmat4 map{1};
    bool identity = true;
    double borderShift = 0;  // UV
    double outward = 1;      // -1: the map mirrors, which turns triangles around

    glm::dvec3 at(uint32_t triangle, uint32_t corner) const;
    glm::dvec3 normal(uint32_t triangle) const;   // unit, outward; 0 of a triangle without area
    glm::dvec3 winding(uint32_t triangle) const;  // likewise, from where its corners go around to the left
    // scale: of the mesh's metres in the search's.
    ContactShape shape(uint32_t triangle, double scale) const;
    // What a stretch belongs to, so that the triangles on both sides of an edge find it once.
    uint64_t keyOf(uint32_t triangle, int edge) const;
};

// A stretch of contact: of each side what it belongs to, and a triangle there.
struct ContactStretch {
    std::array<uint64_t, 2> key;
    std::array<uint32_t, 2> triangle;
    ContactSegment segment;
};

// Between the shells of one mesh, and where a border of a shell lies against its own middle.
std::vector<ContactStretch> stretchesWithin(const ContactView& view, const BoxTree& tree, double tolerance);

// Between two; a's space is that of the search.
std::vector<ContactStretch> stretchesBetween(const ContactView& a, const BoxTree& treeA, const ContactView& b,
                                             const BoxTree& treeB, double tolerance);

}  // namespace espalier
