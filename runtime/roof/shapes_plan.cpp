// In: a footprint, its outline repaired. Out: speeds of the wavefront, the inverse of slopes, edge by edge, and above
// the break. A gable is an edge that doesn't move.
#include "runtime/roof/shapes_plan.hpp"

#include <algorithm>
#include <cmath>

#include "runtime/roof/footprint_heights.hpp"
#include "runtime/roof/shapes_gables.hpp"

namespace espalier {

namespace {

constexpr double kMansardTop = 0.364;  // tangent of 20 degrees
constexpr double kGambrelTop = 0.577;  // of 30
constexpr double kLeastRidge = 0.5;    // metres; shorter ones are a point

// Whether the shape has gables at the ends of its ridge.
bool hasGables(RoofShape shape) {
    return shape == RoofShape::gable || shape == RoofShape::halfHip || shape == RoofShape::gambrel;
}

}  // namespace

RoofPlanner::RoofPlanner(const Footprint& footprint, const RepairedOutline& outline, const OutlineEdges& edges,
                         const OutlineNeighbours& neighbours, RoofAttempts& attempts,
                         std::vector<Diagnostic>& diagnostics)
    : footprint_(footprint),
      outline_(outline),
      edges_(edges),
      attempts_(attempts),
      diagnostics_(diagnostics),
      ridge_(askedRidge(footprint, edges)) {
    for (size_t e = 0; e < edges.corner.size(); e++) closed_.push_back(neighbours.closes(e));
}

bool RoofPlanner::giveUpWish() {
    if (ridge_) {
        say("its ridge could not be laid as roof:direction or roof:orientation asks");
        ridge_.reset();
        return true;
    }
    if (std::find(closed_.begin(), closed_.end(), true) == closed_.end()) return false;
    say("its roof could not be ended at its neighbours' walls");
    closed_.assign(closed_.size(), false);
    return true;
}

void RoofPlanner::say(const std::string& what) {
    diagnostics_.push_back({{}, 0, 0, footprint_.id, what, true});
}

double RoofPlanner::slopeOf(RoofShape shape) const {
    return std::clamp(footprint_.slope.value_or(usualSlope(shape)), 0.01, kSteepestRoof);
}

std::optional<double> RoofPlanner::fallOf() const {
    if (footprint_.direction || footprint_.orientation != RidgeOrientation::across) return footprint_.direction;
    const glm::dvec2 length = lengthOf(edges_);
    return std::atan2(length.x, length.y);
}

RoofPlan RoofPlanner::planOf(RoofShape shape, bool plain) {
    RoofPlan plan;
    plan.input.rings = outline_.rings;
    size_t count = edges_.corner.size();
    double slope = slopeOf(shape);
    std::vector<double>& speeds = plan.input.speeds;
    speeds.assign(count, 1 / slope);
    plan.level = shape == RoofShape::flat;
    if (plan.level || plain) {
        speeds.assign(count, 1);
        return plan;
    }
    if (shape == RoofShape::pyramid && !pyramid(slope, speeds))
        say("its middle lies too near some eaves for a pyramid: a hip roof instead");
    if (shape != RoofShape::pyramid) chooseGables(shape, speeds);
    ownSlopes(speeds);
    breakSlopes(shape, slope, plan);
    return plan;
}

// What goes on above a break: the hip of a half hip, the flatter part of a gambrel and a mansard.
void RoofPlanner::breakSlopes(RoofShape shape, double slope, RoofPlan& plan) {
    std::vector<double>& above = plan.input.speedsAbove;
    above = plan.input.speeds;
    if (shape == RoofShape::halfHip) {
        // The hip begins half way up the gable; higher where a third of the ridge wouldn't be left.
        const Ridge ridge = ridgeOf(plan);
        plan.input.breakHeight = ridge.height > 0 ? ridge.height / 2 : INFINITY;
        if (ridge.length > kLeastRidge)
            plan.input.breakHeight = std::max(plan.input.breakHeight, ridge.height - slope * ridge.length / 3);
        for (size_t e = 0; e < above.size(); e++)
            if (above[e] == 0 && !closed_[e]) above[e] = 1 / slope;
    }
    if (shape == RoofShape::gambrel || shape == RoofShape::mansard) {
        bool mansard = shape == RoofShape::mansard;
        const double ridge = ridgeOf(plan).height;
        // A mansard's attic is a storey high; a gambrel breaks half way in.
        plan.input.breakHeight = mansard ? std::min(2.4, 0.6 * ridge) : ridge / 2;
        if (!(ridge > 0)) plan.input.breakHeight = INFINITY;
        plan.input.breakAll = true;
        for (double& s : above) s = s == 0 ? 0 : 1 / std::min(mansard ? kMansardTop : kGambrelTop, 1 / s);
    }
}

RoofPlanner::Ridge RoofPlanner::ridgeOf(const RoofPlan& plan) {
    constexpr double kSameHeight = 1e-3;  // metres
    RoofPlan whole = plan;
    whole.input.breakHeight = INFINITY;
    Ridge ridge;
    attempts_.attempt(whole, [&](Facets& facets) {
        ridge = {};
        const auto each = [&](const auto& use) {
            for (const Facets::Side& s : facets.sides)
                if (!s.dead) use(facets.points[s.from]);
        };
        each([&](glm::dvec3 p) { ridge.height = std::max(ridge.height, p.z); });
        // From the highest point that comes first to the farthest as high, and from there again.
        glm::dvec2 from(0), end(0);
        for (int round = 0; round < 2; ++round, from = end) {
            bool first = round == 0;
            ridge.length = 0;
            each([&](glm::dvec3 p) {
                if (p.z < ridge.height - kSameHeight) return;
                if (first) from = end = glm::dvec2(p), first = false;
                const double length = glm::distance(from, glm::dvec2(p));
                if (length > ridge.length) ridge.length = length, end = glm::dvec2(p);
            });
        }
        return true;
    });
    return ridge;
}

bool RoofPlanner::pyramid(double slope, std::vector<double>& speeds) const {
    if (outline_.rings.size() != 1) return false;
    glm::dvec2 sum(0);
    double twice = 0;
    for (size_t e = 0; e < edges_.corner.size(); e++) {
        glm::dvec2 a = edges_.corner[e], b = edges_.corner[edges_.next[e]];
        double c = a.x * b.y - a.y * b.x;
        twice += c;
        sum += (a + b) * c;
    }
    glm::dvec2 apex = sum / (3 * twice);
    std::vector<double> distance;
    for (size_t e = 0; e < edges_.corner.size(); e++) {
        glm::dvec2 d = edges_.along(e), q = apex - edges_.corner[e];
        distance.push_back(d.x * q.y - d.y * q.x);
    }
    auto [least, most] = std::minmax_element(distance.begin(), distance.end());
    if (!(*least > 0.25 * *most)) return false;  // nor are some faces much steeper than others
    for (size_t e = 0; e < distance.size(); e++) speeds[e] = distance[e] / (slope * *least);
    return true;
}

void RoofPlanner::chooseGables(RoofShape shape, std::vector<double>& speeds) {
    RoofGables gables(outline_, edges_, attempts_);
    if (!ridge_ || !hasGables(shape) || !gables.lay(*ridge_)) {
        gables.endAt(closed_);
        if (hasGables(shape) && !gables.endWings()) say("no edge of it can carry a gable: a hip roof instead");
    }
    for (size_t e = 0; e < speeds.size(); e++)
        if (gables.has(e)) speeds[e] = 0;
}

void RoofPlanner::nameUnusedRidge(RoofShape shape) {
    if (hasGables(shape)) {
        nameDirectionBetweenWalls();
        return;
    }
    if (shape == RoofShape::shed) return nameDirectionBetweenWalls();
    const bool length = shape == RoofShape::hip || shape == RoofShape::mansard;
    if (length && (!ridge_ || liesAlong(*ridge_, edges_))) return;
    const char* key = footprint_.direction ? "roof:direction" : footprint_.orientation ? "roof:orientation" : nullptr;
    if (!key) return;
    say(std::string(key) + (length ? " would turn the ridge of a hip roof, which lies along its length: ignored"
                                   : " means nothing for this shape of roof: ignored"));
}

void RoofPlanner::nameDirectionBetweenWalls() {
    if (ridge_ && footprint_.direction && liesBetweenWalls(*ridge_, edges_))
        say("roof:direction lies between the directions of its walls: the nearest is taken");
}

// What edges have of their own; neighbours in one line then share the first one's.
void RoofPlanner::ownSlopes(std::vector<double>& speeds) {
    std::vector<bool> own(speeds.size());
    for (const EdgeRoof& given : footprint_.edges)
        for (size_t e = 0; e < speeds.size(); e++) {
            if (outline_.sourceEdges[e] != given.edge) continue;
            own[e] = true;
            if (given.slope) speeds[e] = 1 / std::clamp(*given.slope, 0.01, kSteepestRoof);
            if (given.gable && *given.gable) speeds[e] = 0;
            if (given.gable && !*given.gable && speeds[e] == 0) speeds[e] = 1 / slopeOf(RoofShape::hip);
        }
    levelLines(speeds, own);
    if (std::all_of(speeds.begin(), speeds.end(), [](double s) { return s == 0; })) {
        say("all its edges are gables: hips instead");
        for (double& s : speeds) s = 1 / slopeOf(RoofShape::hip);
    }
}

// Neighbours in one line share a slope: that of the one which has its own, else of the first.
void RoofPlanner::levelLines(std::vector<double>& speeds, std::vector<bool>& own) {
    bool differ = false;
    for (int round = 0; round < 2; round++)
        for (size_t e = 0; e < speeds.size(); e++) {
            size_t before = edges_.previous[e];
            if (!edges_.continues(e) || speeds[e] == speeds[before]) continue;
            if (own[e] && !own[before]) continue;
            differ = differ || (own[e] && own[before]);
            speeds[e] = speeds[before];
            own[e] = own[before];
        }
    for (size_t i = speeds.size(); i-- > 0;)
        if (edges_.continues(i)) speeds[edges_.previous[i]] = speeds[i];
    if (differ) say("edges in one line have different slopes: they share the first one's");
}

}  // namespace espalier
