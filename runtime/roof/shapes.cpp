// In: footprints. Out: structures that have passed the check. A shape is a choice of speeds, and of a break, for the
// wavefront; only sheds, whose roof is one plane, are made without it.
#include "runtime/roof/shapes.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <span>

#include "runtime/core/jobs.hpp"
#include "runtime/roof/check.hpp"
#include "runtime/roof/shapes_shed.hpp"
#include "runtime/roof/skeleton.hpp"
#include "runtime/roof/structure_facets.hpp"

namespace espalier {

namespace {

constexpr double kJoin = 1e-5;               // metres: nodes nearer than this are one
constexpr double kStorey = 3;                // metres
constexpr uint64_t kMostWork = 150'000'000;  // of a house, see straightSkeleton: about two seconds
constexpr double kSteepest = 20;             // tangent, 87 degrees
constexpr double kCollinear = 0.0175;        // sine of a degree: such neighbours share a slope
constexpr double kMansardTop = 0.364;        // tangent of 20 degrees
constexpr double kGambrelTop = 0.577;        // of 30
const double kDefaultSlope[] = {0.7, 0.7, 0.7, 1.0, 0.268, 1.732, 2.747, 0};  // by RoofShape

double defaultSlope(RoofShape shape) {
    return kDefaultSlope[size_t(shape)];
}

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

// A skeleton to make, and what becomes of it.
struct Plan {
    SkeletonInput input;
    bool level = false;  // flat: heights count for nothing
};

struct Ring {
    size_t first, count;
};

// The outline's corners and edges by running number.
struct Edges {
    explicit Edges(const std::vector<std::vector<glm::dvec2>>& rings) {
        for (const auto& ring : rings) {
            size_t first = corner.size();
            for (size_t i = 0; i < ring.size(); i++) {
                corner.push_back(ring[i]);
                next.push_back(first + (i + 1) % ring.size());
                previous.push_back(first + (i + ring.size() - 1) % ring.size());
            }
        }
    }
    glm::dvec2 along(size_t e) const { return glm::normalize(corner[next[e]] - corner[e]); }
    double length(size_t e) const { return glm::length(corner[next[e]] - corner[e]); }
    // Sine of the turn at the edge's first corner; > 0: convex.
    double turn(size_t e) const {
        glm::dvec2 a = along(previous[e]), b = along(e);
        return a.x * b.y - a.y * b.x;
    }
    bool continues(size_t e) const {  // the edge goes on in the line of the one before
        return std::abs(turn(e)) < kCollinear && glm::dot(along(previous[e]), along(e)) > 0;
    }
    std::vector<glm::dvec2> corner;
    std::vector<size_t> next, previous;
};

class HouseMaker {
  public:
    HouseMaker(const Footprint& footprint, const RepairedOutline& outline, std::vector<Diagnostic>& diagnostics)
        : footprint_(footprint), outline_(outline), edges_(outline.rings), diagnostics_(diagnostics) {}

    bool append(RoofStructure& out) {
        RoofShape shape = footprint_.shape;
        if (make(shape, out)) return true;
        if (shape != RoofShape::hip && shape != RoofShape::flat) {
            say("its roof could not be made as asked: a hip roof instead");
            if (make(RoofShape::hip, out)) return true;
        }
        plain_ = true;
        if (make(RoofShape::hip, out)) {
            say("its slopes and gables could not be made: a plain hip roof instead");
            return true;
        }
        diagnostics_.push_back({{},
                                0,
                                0,
                                footprint_.id,
                                work_ > 0 ? "no roof that passes the check could be made: left out"
                                          : "its " + std::to_string(edges_.corner.size()) +
                                                " corners cut into each other too often for a roof: left out",
                                false});
        return false;
    }

  private:
    void say(const std::string& what) { diagnostics_.push_back({{}, 0, 0, footprint_.id, what, true}); }

    bool make(RoofShape shape, RoofStructure& out) {
        if (shape == RoofShape::shed) {
            Facets facets = shedFacets(outline_.rings, footprint_.direction, slopeOf(shape));
            cutFacets(facets);
            return finish(facets, shape, out);
        }
        Plan plan = planOf(shape);
        return attempt(plan, [&](Facets& facets) {
            cutFacets(facets);
            return finish(facets, shape, out);
        });
    }

    double slopeOf(RoofShape shape) const {
        double slope = footprint_.slope.value_or(defaultSlope(shape));
        return std::clamp(slope, 0.01, kSteepest);
    }

    // Tries ways to make the skeleton, each surer and slower than the one before, until `use` is content with one.
    bool attempt(const Plan& plan, const std::function<bool(Facets&)>& use) const {
        // Where many corners meet at once, doubles and rounding make a tangle: a way may cost no more than some times
        // what looking at each pair of edges does.
        const uint64_t most = kLeastWayWork + 2 * uint64_t(edges_.corner.size()) * edges_.corner.size();
        for (const Way& way : edges_.corner.size() > kMany ? std::span<const Way>(kWaysOfMany) : kWays) {
            if (work_ == 0) break;
            uint64_t work = std::min(work_, most * (way.precision == Precision::high ? 8 : 1));
            work_ -= work;
            Skeleton skeleton;
            SkeletonInput moved;
            if (way.jitter > 0) moved = jittered(plan.input, way.jitter, way.seed);
            const bool made = straightSkeleton(way.jitter > 0 ? moved : plan.input, way.precision, skeleton, work);
            work_ += work;
            if (!made) continue;
            for (size_t i = 0; i < edges_.corner.size(); i++) skeleton.nodes[i] = glm::dvec3(edges_.corner[i], 0);
            Facets facets;
            if (!facetsOf(skeleton, faceSlopes(plan, skeleton), facets)) continue;
            cleanFacets(facets, kJoin, uint32_t(edges_.corner.size()));
            if (plan.level)
                for (glm::dvec3& p : facets.points) p.z = 0;
            if (use(facets)) return true;
        }
        return false;
    }

    static SkeletonInput jittered(SkeletonInput input, double size, uint32_t seed) {
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
    static std::vector<double> faceSlopes(const Plan& plan, const Skeleton& skeleton) {
        std::vector<double> slopes;
        for (const SkeletonFace& f : skeleton.faces) {
            double speed = f.tier ? plan.input.speedsAbove[f.edge] : plan.input.speeds[f.edge];
            slopes.push_back(plan.level ? 0 : speed > 0 ? 1 / speed : -1);
        }
        return slopes;
    }

    Plan planOf(RoofShape shape) {
        Plan plan;
        plan.input.rings = outline_.rings;
        size_t count = edges_.corner.size();
        double slope = slopeOf(shape);
        std::vector<double>& speeds = plan.input.speeds;
        speeds.assign(count, 1 / slope);
        plan.level = shape == RoofShape::flat;
        if (plan.level || plain_) {
            speeds.assign(count, 1);
            return plan;
        }
        if (shape == RoofShape::pyramid && !pyramid(slope, speeds))
            say("its middle lies too near some eaves for a pyramid: a hip roof instead");
        if (shape == RoofShape::gable || shape == RoofShape::halfHip || shape == RoofShape::gambrel)
            chooseGables(speeds);
        ownSlopes(speeds);
        std::vector<double>& above = plan.input.speedsAbove;
        above = speeds;
        if (shape == RoofShape::halfHip) {
            // The hip begins half way up the gable.
            double ridge = ridgeOf(plan);
            plan.input.breakHeight = ridge > 0 ? ridge / 2 : INFINITY;
            for (double& s : above)
                if (s == 0) s = 1 / slope;
        }
        if (shape == RoofShape::gambrel || shape == RoofShape::mansard) {
            bool mansard = shape == RoofShape::mansard;
            double ridge = ridgeOf(plan);
            // A mansard's attic is a storey high; a gambrel breaks half way in.
            plan.input.breakHeight = mansard ? std::min(2.4, 0.6 * ridge) : ridge / 2;
            if (!(ridge > 0)) plan.input.breakHeight = INFINITY;
            plan.input.breakAll = true;
            for (double& s : above) s = s == 0 ? 0 : 1 / std::min(mansard ? kMansardTop : kGambrelTop, 1 / s);
        }
        return plan;
    }

    // The height that the plan's roof would have without a break; 0: it can't be made.
    double ridgeOf(const Plan& plan) const {
        Plan whole = plan;
        whole.input.breakHeight = INFINITY;
        double ridge = 0;
        attempt(whole, [&](Facets& facets) {
            for (const Facets::Side& s : facets.sides)
                if (!s.dead) ridge = std::max(ridge, facets.points[s.from].z);
            return true;
        });
        return ridge;
    }

    // Speeds that bring all edges to one apex over the centroid, if it lies before all of them.
    bool pyramid(double slope, std::vector<double>& speeds) const {
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

    // Both corners are convex and not blunt, as those of an octagon or a bay are.
    bool endsWing(size_t e) const {
        auto sharp = [&](size_t corner) {
            return edges_.turn(corner) > 0 &&
                   glm::dot(edges_.along(edges_.previous[corner]), edges_.along(corner)) < 0.45;
        };
        return sharp(e) && sharp(edges_.next[e]);
    }

    // A gable stands where a hip roof would be a triangle between two convex corners: at the end of a wing. Of two such
    // neighbours the shorter takes it, in a quadrangle with its ridge across the longer.
    void chooseGables(std::vector<double>& speeds) {
        Plan hips;
        hips.input.rings = outline_.rings;
        hips.input.speeds.assign(speeds.size(), 1);
        std::vector<size_t> ends;
        bool across = footprint_.orientation == RidgeOrientation::across && speeds.size() == 4;
        auto triangles = [&](Facets& facets) {
            ends.clear();
            for (const Facets::Facet& f : facets.facets) {
                if (f.side == kNone) continue;
                uint32_t third = facets.sides[facets.sides[f.side].next].next;
                bool triangle = facets.sides[third].next == f.side;
                if (triangle && endsWing(f.edge)) ends.push_back(f.edge);
            }
            return true;
        };
        if (across)
            ends = {0, 1, 2, 3};
        else
            attempt(hips, triangles);
        std::stable_sort(ends.begin(), ends.end(), [&](size_t a, size_t b) {
            double difference = edges_.length(a) - edges_.length(b);
            return across ? difference > 0.01 : difference < -0.01;
        });
        std::vector<bool> gable(speeds.size());
        for (size_t e : ends)
            if (!gable[edges_.next[e]] && !gable[edges_.previous[e]]) gable[e] = true;
        if (ends.empty()) say("no edge of it can carry a gable: a hip roof instead");
        for (size_t e = 0; e < speeds.size(); e++)
            if (gable[e]) speeds[e] = 0;
    }

    // What edges have of their own; neighbours in one line then share the first one's.
    void ownSlopes(std::vector<double>& speeds) {
        std::vector<bool> own(speeds.size());
        for (const EdgeRoof& given : footprint_.edges)
            for (size_t e = 0; e < speeds.size(); e++) {
                if (outline_.sourceEdges[e] != given.edge) continue;
                own[e] = true;
                if (given.slope) speeds[e] = 1 / std::clamp(*given.slope, 0.01, kSteepest);
                if (given.gable && *given.gable) speeds[e] = 0;
                if (given.gable && !*given.gable && speeds[e] == 0) speeds[e] = 1 / slopeOf(RoofShape::hip);
            }
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
        if (std::all_of(speeds.begin(), speeds.end(), [](double s) { return s == 0; })) {
            say("all its edges are gables: hips instead");
            for (double& s : speeds) s = 1 / slopeOf(RoofShape::hip);
        }
    }

    // Heights, then the check. What doesn't pass leaves no trace.
    bool finish(Facets& facets, RoofShape shape, RoofStructure& out) {
        double ridge = 0;
        for (const Facets::Side& s : facets.sides)
            if (!s.dead) ridge = std::max(ridge, facets.points[s.from].z);
        Heights h = heights(ridge);
        if (ridge > 0 && h.roof != ridge) {
            double scale = h.roof / ridge;
            for (glm::dvec3& p : facets.points) p.z *= scale;
            for (Facets::Facet& f : facets.facets) {
                f.slope *= scale;
                f.eave[0].z *= scale, f.eave[1].z *= scale;
            }
        }
        RoofHouse house{};
        house.id = footprint_.id;
        house.origin = outline_.origin;
        house.baseHeight = float(footprint_.baseHeight);
        house.eaveHeight = float(h.eave);
        house.parapetHeight = shape == RoofShape::flat ? float(footprint_.parapet) : 0;
        house.shape = shape;
        house.material = uint32_t(footprint_.material);
        house.colour = footprint_.colour;
        for (const auto& ring : outline_.rings) house.rings.emplace_back(ring.begin(), ring.end());
        size_t faces = out.faces.size(), segments = out.segments.size();
        appendHouse(facets, std::move(house), out);
        if (checkRoof(out, uint32_t(out.houses.size() - 1)).empty()) return true;
        out.houses.pop_back();
        out.faces.resize(faces);
        out.segments.resize(segments);
        return false;
    }

    struct Heights {
        double eave, roof;
    };
    // Eave and roof height out of what is given: the roof's own height counts most, then the whole height, then
    // storeys.
    Heights heights(double ridge) const {
        const Footprint& f = footprint_;
        double base = f.baseHeight, roof = ridge;
        std::optional<double> eave;
        if (f.levels) eave = base + kStorey * std::max(*f.levels, 0.0);
        if (ridge > 0 && f.roofHeight)
            roof = *f.roofHeight;
        else if (ridge > 0 && !f.slope && f.height && eave && *f.height - *eave > 0.3)
            roof = *f.height - *eave;
        else if (ridge > 0 && !f.slope && f.roofLevels && *f.roofLevels > 0)
            roof = kStorey * *f.roofLevels;
        if (f.height) {
            // Walls keep at least a third of the height.
            double whole = std::max(*f.height - base, 0.1);
            roof = std::min(roof, whole * 2 / 3);
            eave = base + whole - roof;
        }
        double most = ridge * kSteepest;
        return {eave.value_or(base + 2 * kStorey),
                std::min(std::max(roof, ridge > 0 ? 0.01 : 0.0), std::max(most, 0.0))};
    }

    const Footprint& footprint_;
    const RepairedOutline& outline_;
    const Edges edges_;
    std::vector<Diagnostic>& diagnostics_;
    mutable uint64_t work_ = kMostWork;  // that is left, for all attempts together
    bool plain_ = false;                 // slopes and gables of its own don't count
};

}  // namespace

bool appendRoof(const Footprint& footprint, RoofStructure& out, std::vector<Diagnostic>& diagnostics) {
    bool any = false;
    for (const RepairedOutline& outline : repairOutline(footprint, diagnostics))
        any = HouseMaker(footprint, outline, diagnostics).append(out) || any;
    return any;
}

RoofStructure roofOf(const Footprint& footprint, std::vector<Diagnostic>& diagnostics) {
    RoofStructure out;
    appendRoof(footprint, out, diagnostics);
    return out;
}

RoofStructure roofsOf(const std::vector<Footprint>& footprints, std::vector<Diagnostic>& diagnostics) {
    constexpr size_t kGrain = 64;
    size_t pieces = (footprints.size() + kGrain - 1) / kGrain;
    std::vector<RoofStructure> parts(pieces);
    std::vector<std::vector<Diagnostic>> said(pieces);
    parallelFor(footprints.size(), kGrain, [&](size_t begin, size_t end) {
        for (size_t i = begin; i < end; i++) appendRoof(footprints[i], parts[begin / kGrain], said[begin / kGrain]);
    });
    RoofStructure out;
    for (size_t p = 0; p < pieces; p++) {
        uint32_t house = uint32_t(out.houses.size()), face = uint32_t(out.faces.size()),
                 segment = uint32_t(out.segments.size());
        for (RoofHouse& h : parts[p].houses) h.firstFace += face, out.houses.push_back(std::move(h));
        for (RoofFace f : parts[p].faces) f.house += house, f.firstSegment += segment, out.faces.push_back(f);
        for (ChainSegment s : parts[p].segments) {
            if (s.face != kNoFace) s.face += face;
            if (s.segment != kNoFace) s.segment += segment;
            out.segments.push_back(s);
        }
        diagnostics.insert(diagnostics.end(), said[p].begin(), said[p].end());
    }
    return out;
}

}  // namespace espalier
