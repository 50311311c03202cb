// In: heights and storeys that tags give, all from the ground. Out: eave and ridge. A roof's own height counts most,
// then the whole height, then storeys.
#include "runtime/roof/footprint_heights.hpp"

#include <algorithm>
#include <cmath>

namespace espalier {

namespace {

constexpr double kDefaultSlope[] = {0.7, 0.7, 0.7, 1.0, 0.268, 1.732, 2.747, 0};  // by RoofShape
constexpr double kLeastWall = 0.1;  // metres; a house whose storeys say so has none

std::optional<double> eaveOfStoreys(const Footprint& f) {
    if (f.wallHeight) return f.baseHeight + *f.wallHeight;
    if (f.levels) return std::max(f.baseHeight, kStorey * *f.levels);
    return {};
}

bool saysRoof(const Footprint& f) {
    return f.shaped || f.slope || f.roofHeight || f.roofLevels;
}

}  // namespace

double usualSlope(RoofShape shape) {
    return kDefaultSlope[size_t(shape)];
}

RoofHeights heightsOf(const Footprint& f, double ridge, double slope) {
    const std::optional<double> storeys = eaveOfStoreys(f);
    double roof = ridge, most = kMostRoof;
    if (ridge > 0 && f.roofHeight)
        roof = *f.roofHeight;
    else if (ridge > 0 && !f.slope && f.height && storeys && *f.height - *storeys > 0.3)
        roof = *f.height - *storeys;
    else if (ridge > 0 && !f.slope && f.roofLevels && *f.roofLevels > 0)
        roof = kStorey * *f.roofLevels;
    else if (ridge > 0 && !saysRoof(f) && 2 * ridge / slope > kHallWidth)
        roof = std::min(roof, ridge * kHallSlope / slope), most = kMostHallRoof;
    double eave = storeys.value_or(f.baseHeight + (f.open ? 1 : 2) * kStorey);
    if (f.height) {
        const double whole = std::max(*f.height - f.baseHeight, kLeastWall);
        const bool noWalls = storeys && *storeys <= f.baseHeight;
        roof = std::min(roof, f.roofHeight || noWalls ? whole : whole * most);
        eave = f.baseHeight + whole - roof;
    }
    if (ridge > 0) roof = std::clamp(roof, 0.01, std::max(ridge * kSteepestRoof, 0.01));
    return {eave, roof};
}

RoughHeights roughHeightsOf(const Footprint& f) {
    double area = 0, around = 0;
    const auto& ring = f.rings[0];
    for (size_t i = 0; i < ring.size(); ++i) {
        const glm::dvec2 a = ring[i] - ring[0], b = ring[(i + 1) % ring.size()] - ring[0];
        area += (a.x * b.y - a.y * b.x) / 2;
        around += glm::length(b - a);
    }
    // Half the width: exact for long rectangles, four tenths too large for squares.
    const double half = around > 0 ? 1.4 * std::abs(area) / around : 0;
    const double slope = f.slope.value_or(usualSlope(f.shape));
    const RoofHeights h = heightsOf(f, f.shape == RoofShape::flat ? 0 : half * slope, slope);
    return {h.eave, h.eave + h.roof};
}

}  // namespace espalier
