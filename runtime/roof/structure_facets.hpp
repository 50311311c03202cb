#pragma once

// A roof as a plane graph of facets while it is made: from the skeleton's arcs to the faces of structure.hpp.
// Internal to runtime/roof.

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "runtime/roof/skeleton.hpp"
#include "runtime/roof/structure.hpp"

namespace espalier {

constexpr uint32_t kNone = ~0u;

struct Facets {
    struct Side {  // from its point to that of the next side; the facet is to its left, seen from outside
        uint32_t from, facet, next, previous;
        uint32_t twin;  // kNone: the border of the roof
        bool eave, dead;
    };
    struct Facet {
        uint32_t edge, tier;
        FaceKind kind;
        double slope;
        glm::dvec3 eave[2];        // x, y, height above the wall's top
        glm::dvec2 along, uphill;  // unit, plan
        uint32_t side;             // any of it; kNone: the facet is gone
    };
    std::vector<glm::dvec3> points;  // x, y, height above the wall's top
    std::vector<Side> sides;
    std::vector<Facet> facets;

    uint32_t to(uint32_t side) const { return sides[sides[side].next].from; }
    uint32_t addSide(uint32_t from, uint32_t facet, bool eave);
    void link(uint32_t a, uint32_t b);
    void pair(uint32_t a, uint32_t b);
    // Puts a point into the side and its twin. Returns the side that begins there.
    uint32_t splitSide(uint32_t side, uint32_t point);
};

// The skeleton's faces as closed loops; kinds and slopes by face. False: a face doesn't close.
bool facetsOf(const Skeleton& skeleton, const std::vector<double>& slopes, Facets& out);

// Joins points nearer than `tolerance`, and removes sides, spurs, corners and facets that are nothing then.
// The first `fixed` points stay.
void cleanFacets(Facets& facets, double tolerance, uint32_t fixed);

// Cuts facets (loops with holes, too) until each is one loop, monotone along its eave.
void cutFacets(Facets& facets);

// Appends the facets as the faces of `house`, which is complete but for faces and ridge height.
void appendHouse(const Facets& facets, RoofHouse house, RoofStructure& out);

}  // namespace espalier
