#pragma once

// Footprints as areas of the plan: bounds, places inside, pairs that lie near each other.

#include <cstdint>
#include <utility>
#include <vector>

#include "runtime/roof/footprint.hpp"

namespace espalier {

struct PlanBounds {
    explicit PlanBounds(const Footprint& footprint);
    bool meets(const PlanBounds& other, double slack) const;
    glm::dvec2 low{INFINITY}, high{-INFINITY};
};

double areaOf(const Footprint& footprint);  // square metres, without the holes
// Twice the area that a ring encloses, negative where it runs clockwise. Rounding counts from the first corner.
double twiceAreaOf(const std::vector<glm::dvec2>& ring);
// A point inside, away from the outline where there is room.
glm::dvec2 innerPoint(const Footprint& footprint);
bool holds(const Footprint& footprint, glm::dvec2 point);

// Pairs of footprints whose bounds come within `slack` of each other, in a fixed order; none where finding them takes
// too many comparisons, or there are too many.
using FootprintPairs = std::vector<std::pair<uint32_t, uint32_t>>;
std::optional<FootprintPairs> nearPairs(const std::vector<Footprint>& footprints, double slack, uint64_t mostTests,
                                        uint64_t mostPairs);

}  // namespace espalier
