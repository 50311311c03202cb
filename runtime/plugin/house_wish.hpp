#pragma once

// What a designer wants of one house, and the footprint that it makes of the house's plan.

#include <vector>

#include "plugin_api/espalier.h"
#include "runtime/roof/footprint.hpp"
#include "runtime/roof/structure.hpp"

namespace espalier {

// All of it: what a definition leaves out is as it stands.
struct HouseWish {
    RoofShape shape;
    float slope;       // 0: none of its own
    float eaveHeight;  // metres above the base
    std::vector<EspHouseEdge> edges;
    std::vector<std::vector<glm::dvec2>> rings;  // plan metres: world x and -z; edges count over them
    EspHouseLook look;
};
HouseWish wishOf(const RoofHouse& now, const EspHouseDef& def);

// From the plan and the wish alone, whatever the house was made into before: so the same wish gives the same house.
// planned: the house as its plan has it.
Footprint footprintFor(const Footprint& plan, const RoofHouse& planned, const HouseWish& wish);

// World x and z of a corner of a ring.
glm::vec2 worldCorner(const RoofHouse& house, glm::vec2 corner);
EspHouseEdge edgeOf(const EdgeRoof& edge);
EspHouseLook lookOf(const RoofHouse& house);

}  // namespace espalier
