// In: plans, outlines with the speeds of their edges. Out: facets, whose small things are cleaned away. Where ties
// can't be told in doubles, precision rises and corners are moved a little.
#include "runtime/roof/shapes_attempts.hpp"

#include <algorithm>
#include <cmath>
#include <span>

namespace espalier {

namespace {

constexpr double kJoin = 1e-5;         // metres: nodes nearer than this are one
constexpr double kCollinear = 0.0175;  // sine of a degree

// A way to make a skeleton. Corners moved by less than kJoin take ties apart; the nodes so made fall into one again.
struct Way {
    Precision precision;
    double jitter;
    uint32_t seed;
};
// Each surer and slower than the one before.
constexpr Way kWays[] = {{Precision::fast, 0, 0},    {Precision::high, 0, 0},    {Precision::fast, 1e-7, 1},
                         {Precision::high, 1e-8, 2}, {Precision::high, 1e-7, 3}, {Precision::high, 1e-6, 4},
                         {Precision::high, 1e-6, 5}, {Precision::high, 3e-6, 6}};
// Of outlines with many corners: there ties come by the hundred, in stars say, and taking them apart is cheaper.
constexpr size_t kMany = 200;
constexpr Way kWaysOfMany[] = {{Precision::fast, 0, 0},    {Precision::fast, 1e-7, 1}, {Precision::fast, 1e-6, 2},
                               {Precision::fast, 3e-6, 3}, {Precision::high, 0, 0},    {Precision::high, 1e-7, 4},
                               {Precision::high, 1e-6, 5}, {Precision::high, 3e-6, 6}};
constexpr uint64_t kLeastWayWork = 1'000'000;

SkeletonInput jittered(SkeletonInput input, double size, uint32_t seed) {
    uint32_t state = seed * 2654435761u + 1;
    auto random = [&] {
        state = state * 1664525u + 1013904223u;
        return (double(state >> 8) / (1u << 23) - 1) * size;
    };
    for (auto& ring : input.rings)
        for (glm::dvec2& p : ring) p += glm::dvec2(random(), random());
    return input;
}

// 0: level; negative: a gable.
std::vector<double> faceSlopes(const RoofPlan& plan, const Skeleton& skeleton) {
    std::vector<double> slopes;
    for (const SkeletonFace& f : skeleton.faces) {
        double speed = f.tier ? plan.input.speedsAbove[f.edge] : plan.input.speeds[f.edge];
        slopes.push_back(plan.level ? 0 : speed > 0 ? 1 / speed : -1);
    }
    return slopes;
}

}  // namespace

OutlineEdges::OutlineEdges(const std::vector<std::vector<glm::dvec2>>& rings) {
    for (const auto& ring : rings) {
        size_t first = corner.size();
        for (size_t i = 0; i < ring.size(); i++) {
            corner.push_back(ring[i]);
            next.push_back(first + (i + 1) % ring.size());
            previous.push_back(first + (i + ring.size() - 1) % ring.size());
        }
    }
}

double OutlineEdges::turn(size_t e) const {
    glm::dvec2 a = along(previous[e]), b = along(e);
    return a.x * b.y - a.y * b.x;
}

bool OutlineEdges::continues(size_t e) const {
    return std::abs(turn(e)) < kCollinear && glm::dot(along(previous[e]), along(e)) > 0;
}

bool RoofAttempts::attempt(const RoofPlan& plan, const std::function<bool(Facets&)>& use) {
    // Where many corners meet at once, doubles and rounding make a tangle: a way may cost no more than some times
    // what looking at each pair of edges does.
    std::vector<glm::dvec2> corners;
    for (const auto& ring : plan.input.rings) corners.insert(corners.end(), ring.begin(), ring.end());
    const uint64_t most = kLeastWayWork + 2 * uint64_t(corners.size()) * corners.size();
    for (const Way& way : corners.size() > kMany ? std::span<const Way>(kWaysOfMany) : kWays) {
        if (work_ == 0) break;
        uint64_t work = std::min(work_, most * (way.precision == Precision::high ? 8 : 1));
        work_ -= work;
        Skeleton skeleton;
        SkeletonInput moved;
        if (way.jitter > 0) moved = jittered(plan.input, way.jitter, way.seed);
        const bool made = straightSkeleton(way.jitter > 0 ? moved : plan.input, way.precision, skeleton, work);
        work_ += work;
        if (!made) continue;
        for (size_t i = 0; i < corners.size(); i++) skeleton.nodes[i] = glm::dvec3(corners[i], 0);
        Facets facets;
        if (!facetsOf(skeleton, faceSlopes(plan, skeleton), facets)) continue;
        cleanFacets(facets, kJoin, uint32_t(corners.size()));
        if (plan.level)
            for (glm::dvec3& p : facets.points) p.z = 0;
        if (use(facets)) return true;
    }
    return false;
}

}  // namespace espalier
