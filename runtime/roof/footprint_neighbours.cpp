// In: a town's footprints. Out: the stretches of their walls against which others stand, and level roofs under parts
// that stand on them.
#include "runtime/roof/footprint_neighbours.hpp"

#include <algorithm>
#include <cmath>

#include "runtime/roof/footprint_heights.hpp"
#include "runtime/roof/footprint_plan.hpp"

namespace espalier {

namespace {

constexpr double kGap = 0.3;          // metres between walls that count as one, or that they overlap
constexpr double kLeastShared = 0.5;  // metres
constexpr double kTurned = 0.996;     // cosine of 5 degrees
constexpr double kLow = 0.3;          // metres: what stands higher than an eave by less is no obstacle
constexpr double kAlike = 0.6;        // of one's walls' height that the other's have, if they stand in one row
constexpr double kParapet = 0.6;      // metres above a flat roof
constexpr double kStep = 1;           // metres: how exactly heights of parts that stand on each other agree
constexpr uint64_t kMostTests = 50'000'000, kMostPairs = 4'000'000;

struct Standing {
    double base, eave, top;
};

Standing standingOf(const Footprint& f) {
    const RoughHeights h = roughHeightsOf(f);
    return {f.baseHeight, h.eave, h.top + (f.shape == RoofShape::flat ? kParapet : 0)};
}

// Whether `upper` stands on `lower`, or rises out of it.
bool standsOn(const Footprint& upper, const Standing& u, const Footprint& lower, const Standing& l) {
    const bool meets = u.base > l.base + kStep && u.base < l.top + kStep && u.top > l.eave + kLow;
    return meets && (holds(lower, innerPoint(upper)) || holds(upper, innerPoint(lower)));
}

// A wall of a footprint, inside to its left.
struct Wall {
    glm::dvec2 from, to;
    glm::dvec2 along() const { return glm::normalize(to - from); }
};

// Those that reach the bounds.
std::vector<Wall> wallsNear(const Footprint& f, const PlanBounds& bounds) {
    std::vector<Wall> walls;
    for (size_t r = 0; r < f.rings.size(); ++r) {
        const auto& ring = f.rings[r];
        const bool forward = (twiceAreaOf(ring) > 0) == (r == 0);
        for (size_t i = 0; i < ring.size(); ++i) {
            const glm::dvec2 a = ring[i], b = ring[(i + 1) % ring.size()];
            const glm::dvec2 low = glm::min(a, b), high = glm::max(a, b);
            const bool misses = low.x > bounds.high.x + kGap || high.x < bounds.low.x - kGap ||
                                low.y > bounds.high.y + kGap || high.y < bounds.low.y - kGap;
            if (misses || glm::distance(a, b) < kLeastShared) continue;
            walls.push_back(forward ? Wall{a, b} : Wall{b, a});
        }
    }
    return walls;
}

// The stretch of `wall` that `other` faces; empty where there is none worth a name.
std::optional<Wall> sharedStretch(const Wall& wall, const Wall& other) {
    const glm::dvec2 along = wall.along(), left(-along.y, along.x);
    if (glm::dot(along, other.along()) > -kTurned) return {};
    const auto place = [&](glm::dvec2 p) { return glm::dot(p - wall.from, along); };
    const double begin = std::max(0.0, place(other.to)),
                 end = std::min(glm::distance(wall.from, wall.to), place(other.from));
    if (end - begin < kLeastShared) return {};
    // How far the other wall lies off at either end of the stretch.
    const double a = place(other.to), b = place(other.from);
    const auto off = [&](double t) {
        return glm::dot(glm::mix(other.to, other.from, (t - a) / (b - a)) - wall.from, left);
    };
    if (std::max(std::abs(off(begin)), std::abs(off(end))) > kGap) return {};
    return Wall{wall.from + begin * along, wall.from + end * along};
}

class Neighbours {
  public:
    explicit Neighbours(std::vector<Footprint>& footprints) : footprints_(footprints) {}

    // False: there is too much to compare.
    bool find() {
        const std::optional<FootprintPairs> pairs = nearPairs(footprints_, kGap, kMostTests, kMostPairs);
        if (!pairs) return false;
        measure();
        for (const auto& [a, b] : *pairs) level(a, b), level(b, a);
        if (tests_ > kMostTests) return false;
        measure();
        for (const auto& [a, b] : *pairs) {
            share(a, b);
            if (tests_ > kMostTests) return false;
        }
        return true;
    }

  private:
    void measure() {
        standing_.clear();
        for (const Footprint& f : footprints_) standing_.push_back(standingOf(f));
    }
    void level(uint32_t lower, uint32_t upper) {
        Footprint& f = footprints_[lower];
        const bool said = f.shaped || f.shape == RoofShape::flat || f.roofHeight || f.slope || f.roofLevels;
        if (said || footprints_[upper].baseHeight <= 0 || tests_ > kMostTests) return;
        tests_ += f.rings[0].size() + footprints_[upper].rings[0].size();
        if (standsOn(footprints_[upper], standing_[upper], f, standing_[lower])) f.shape = RoofShape::flat;
    }
    void share(uint32_t a, uint32_t b) {
        Footprint &f = footprints_[a], &g = footprints_[b];
        const Standing &s = standing_[a], &t = standing_[b];
        if (std::min(s.top, t.top) - std::max(s.base, t.base) < kLow) return;
        const std::vector<Wall> walls = wallsNear(f, PlanBounds(g)), others = wallsNear(g, PlanBounds(f));
        tests_ += f.rings[0].size() + g.rings[0].size() + walls.size() * others.size();
        if (tests_ > kMostTests) return;
        for (const Wall& wall : walls)
            for (const Wall& other : others) {
                if (const auto stretch = sharedStretch(wall, other)) note(f, s, *stretch, g, t);
                if (const auto stretch = sharedStretch(other, wall)) note(g, t, *stretch, f, s);
            }
    }
    // `other` stands against a wall of the footprint. Roofs on posts leave windows free.
    static void note(Footprint& f, const Standing& own, const Wall& wall, const Footprint& other, const Standing& its) {
        if (other.open) return;
        const bool endsRoof = its.top > own.eave + kLow;
        f.shared.push_back({wall.from, wall.to, its.top, endsRoof, endsRoof || its.eave >= kAlike * own.eave});
    }

    std::vector<Footprint>& footprints_;
    std::vector<Standing> standing_;
    uint64_t tests_ = 0;
};

}  // namespace

void findNeighbours(Town& town) {
    std::vector<Footprint>& all = town.footprints;
    if (Neighbours(all).find()) return;
    for (Footprint& f : all) f.shared.clear();
    addMessages(town.diagnostics,
                {{{}, 0, 0, {}, "too many footprints lie over each other: no walls count as shared", true}});
}

}  // namespace espalier
