#pragma once

// How high a footprint's walls and roof are, out of what its tags say.

#include "runtime/roof/footprint.hpp"

namespace espalier {

constexpr double kStorey = 3;          // metres
constexpr double kMostRoof = 2.0 / 3;  // of a height that is given, where nothing says how high the roof is itself
constexpr double kSteepestRoof = 20;   // tangent, 87 degrees

// Wider outlines of which nothing says what roof they carry are halls: their roofs are low.
constexpr double kHallWidth = 15;          // metres
constexpr double kHallSlope = 0.176;       // tangent of 10 degrees
constexpr double kMostHallRoof = 1.0 / 3;  // as kMostRoof

struct RoofHeights {
    double eave;  // metres above the ground
    double roof;  // from eave to ridge
};
// ridge: height of the roof at `slope`, the tangent of its pitch, over this outline; 0: level.
RoofHeights heightsOf(const Footprint& footprint, double ridge, double slope);

// The same without a roof's structure, good to a metre or so: for comparing neighbours.
struct RoughHeights {
    double eave, top;
};
RoughHeights roughHeightsOf(const Footprint& footprint);

// Tangent of a shape's usual pitch.
double usualSlope(RoofShape shape);

}  // namespace espalier
