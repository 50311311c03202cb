// In: footprints. Out: what of them lies where. A sweep from west to east finds pairs.
#include "runtime/roof/footprint_plan.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace espalier {

namespace {

using Ring = std::vector<glm::dvec2>;

// Where a level line meets the outline, from west to east: between the first and the second lies the inside.
std::vector<double> crossings(const Footprint& f, double y) {
    std::vector<double> xs;
    for (const Ring& ring : f.rings)
        for (size_t i = 0, j = ring.size() - 1; i < ring.size(); j = i++) {
            const glm::dvec2 a = ring[i], b = ring[j];
            if ((a.y > y) != (b.y > y)) xs.push_back(a.x + (b.x - a.x) * (y - a.y) / (b.y - a.y));
        }
    std::sort(xs.begin(), xs.end());
    return xs;
}

}  // namespace

PlanBounds::PlanBounds(const Footprint& f) {
    for (glm::dvec2 p : f.rings[0]) low = glm::min(low, p), high = glm::max(high, p);
}

bool PlanBounds::meets(const PlanBounds& o, double slack) const {
    return low.x <= o.high.x + slack && o.low.x <= high.x + slack && low.y <= o.high.y + slack &&
           o.low.y <= high.y + slack;
}

double twiceAreaOf(const Ring& ring) {
    double twice = 0;
    for (size_t i = 0, j = ring.size() - 1; i < ring.size(); j = i++) {
        const glm::dvec2 a = ring[j] - ring[0], b = ring[i] - ring[0];
        twice += a.x * b.y - a.y * b.x;
    }
    return twice;
}

double areaOf(const Footprint& f) {
    double sum = 0;
    for (size_t r = 0; r < f.rings.size(); r++) sum += (r == 0 ? 0.5 : -0.5) * std::abs(twiceAreaOf(f.rings[r]));
    return sum;
}

// In the widest stretch of a level line half way up, which meets no corner but by chance.
glm::dvec2 innerPoint(const Footprint& f) {
    const PlanBounds bounds(f);
    const double y = bounds.low.y + 0.4871 * (bounds.high.y - bounds.low.y);
    const std::vector<double> xs = crossings(f, y);
    glm::dvec2 best(f.rings[0][0].x, y);
    double widest = -1;
    for (size_t i = 0; i + 1 < xs.size(); i += 2)
        if (xs[i + 1] - xs[i] > widest) widest = xs[i + 1] - xs[i], best.x = (xs[i] + xs[i + 1]) / 2;
    return best;
}

bool holds(const Footprint& f, glm::dvec2 p) {
    const std::vector<double> xs = crossings(f, p.y);
    return (std::lower_bound(xs.begin(), xs.end(), p.x) - xs.begin()) % 2 == 1;
}

std::optional<FootprintPairs> nearPairs(const std::vector<Footprint>& footprints, double slack, uint64_t mostTests,
                                        uint64_t mostPairs) {
    std::vector<PlanBounds> bounds(footprints.begin(), footprints.end());
    std::vector<uint32_t> order(footprints.size()), near;  // near: begin west of the next one and may reach it
    std::iota(order.begin(), order.end(), 0u);
    std::stable_sort(order.begin(), order.end(),
                     [&](uint32_t a, uint32_t b) { return bounds[a].low.x < bounds[b].low.x; });
    FootprintPairs pairs;
    uint64_t tests = 0;
    for (uint32_t i : order) {
        std::erase_if(near, [&](uint32_t n) { return bounds[n].high.x + slack < bounds[i].low.x; });
        tests += near.size();
        if (tests > mostTests || pairs.size() > mostPairs) return {};
        for (uint32_t n : near)
            if (bounds[n].meets(bounds[i], slack)) pairs.emplace_back(std::min(n, i), std::max(n, i));
        near.push_back(i);
    }
    return pairs;
}

}  // namespace espalier
