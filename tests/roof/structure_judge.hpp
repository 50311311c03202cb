#pragma once

// Judges roofs without sharing code with runtime/roof: it knows structure.hpp's records and nothing else.

#include <functional>
#include <string>

#include "runtime/roof/structure.hpp"

namespace espalier::test {

struct Verdict {
    std::string problem;  // empty: none found
    double area = 0;      // of the footprint
};

// Area and samples (every point of the footprint under exactly one face), planes by Newell's normal, their slopes,
// every piece of a face's border shared with exactly one other face or part of the footprint's, eaves at one height.
// `slope` gives the tangent asked of a face; negative: not asked.
Verdict judge(const RoofStructure& roof, uint32_t house, const std::function<double(const RoofFace&)>& slope = {});

// Height of the roof above the eave over a plan point of the house; NaN outside.
double heightAt(const RoofStructure& roof, uint32_t house, glm::dvec2 p);

// The face's outline, x east, y north, z up.
std::vector<glm::dvec3> outlineOf(const RoofStructure& roof, const RoofFace& face);

}  // namespace espalier::test
