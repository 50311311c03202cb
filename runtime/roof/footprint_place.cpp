// In: footprints in degrees or in metres of any grid. Out: footprints near their own origin.
#include "runtime/roof/footprint_place.hpp"

#include <algorithm>
#include <cmath>

namespace espalier {

namespace {

constexpr double kFarthest = 100000;  // metres from the town's middle
constexpr double kFarPlan = 10000;    // metres: a plan's own origin counts as near up to there

// The median of the features, which one stray feature doesn't move.
glm::dvec2 medianOf(const std::vector<Footprint>& footprints) {
    std::vector<double> xs, ys;
    for (const Footprint& f : footprints) xs.push_back(f.rings[0][0].x), ys.push_back(f.rings[0][0].y);
    const auto median = [](std::vector<double>& v) {
        std::nth_element(v.begin(), v.begin() + std::ptrdiff_t(v.size() / 2), v.end());
        return v[v.size() / 2];
    };
    return {median(xs), median(ys)};
}

template <class Change>
void eachCorner(std::vector<Footprint>& footprints, const Change& change) {
    for (Footprint& f : footprints)
        for (auto& ring : f.rings)
            for (glm::dvec2& p : ring) change(p);
}

// Longitudes within half a turn of `middle`.
void unwrap(std::vector<Footprint>& footprints, double middle) {
    eachCorner(footprints, [&](glm::dvec2& p) { p.x -= 360 * std::round((p.x - middle) / 360); });
}

// Metres in a degree of longitude and of latitude, by WGS 84's radii of curvature.
glm::dvec2 metresInDegree(double latitude) {
    constexpr double a = 6378137, e2 = 6.69437999014e-3;
    const double phi = glm::radians(latitude), w = 1 - e2 * std::sin(phi) * std::sin(phi);
    return glm::radians(1.0) * glm::dvec2(a / std::sqrt(w) * std::cos(phi), a * (1 - e2) / (w * std::sqrt(w)));
}

}  // namespace

void placeTown(Town& town, bool geographic, const std::string& file) {
    std::vector<Footprint>& all = town.footprints;
    town.geographic = geographic;
    if (all.empty()) return;
    if (geographic) unwrap(all, all[0].rings[0][0].x);
    glm::dvec2 middle = medianOf(all), scale(1);
    if (geographic) {
        unwrap(all, middle.x);
        scale = metresInDegree(middle.y);
        town.origin = {middle.x - 360 * std::round(middle.x / 360), middle.y};
    } else {
        middle = glm::length(middle) > kFarPlan ? glm::round(middle) : glm::dvec2(0);
        town.origin = middle;
    }
    eachCorner(all, [&](glm::dvec2& p) { p = (p - middle) * scale; });
    std::erase_if(all, [&](const Footprint& f) {
        for (const auto& ring : f.rings)
            for (glm::dvec2 p : ring)
                if (glm::length(p) > kFarthest) {
                    addMessages(
                        town.diagnostics,
                        {{file, 0, 0, f.id, "lies more than 100 km from the middle of the town: left out", false}});
                    return true;
                }
        return false;
    });
}

}  // namespace espalier
