// In: footprints. Out: structures that have passed the check. Each kind of roof is a plan for the wavefront
// (shapes_plan.hpp); only sheds, whose roof is one plane, are made without it.
#include "runtime/roof/shapes.hpp"

#include <algorithm>

#include "runtime/core/jobs.hpp"
#include "runtime/roof/check.hpp"
#include "runtime/roof/shapes_plan.hpp"
#include "runtime/roof/shapes_shed.hpp"

namespace espalier {

namespace {

constexpr double kStorey = 3;  // metres

class HouseMaker {
  public:
    HouseMaker(const Footprint& footprint, const RepairedOutline& outline, std::vector<Diagnostic>& diagnostics)
        : footprint_(footprint),
          outline_(outline),
          edges_(outline.rings),
          attempts_(edges_),
          planner_(footprint, outline, edges_, attempts_, diagnostics),
          diagnostics_(diagnostics) {}

    bool append(RoofStructure& out) {
        const size_t said = diagnostics_.size();
        if (!appendAny(out)) return false;
        RoofHouse& house = out.houses.back();
        house.edges = ownEdges();
        for (size_t i = said; i < diagnostics_.size(); ++i)
            if (house.note.find(diagnostics_[i].message) == std::string::npos)
                house.note += (house.note.empty() ? "" : "\n") + diagnostics_[i].message;
        return true;
    }

  private:
    // As asked, or as near to it as passes the check.
    bool appendAny(RoofStructure& out) {
        RoofShape shape = footprint_.shape;
        nameUnused(shape);
        if (make(shape, false, out)) return true;
        if (shape != RoofShape::hip && shape != RoofShape::flat) {
            planner_.say("its roof could not be made as asked: a hip roof instead");
            if (make(RoofShape::hip, false, out)) return true;
        }
        if (make(RoofShape::hip, true, out)) {
            planner_.say("its slopes and gables could not be made: a plain hip roof instead");
            return true;
        }
        const std::string why = attempts_.exhausted() ? "its " + std::to_string(edges_.corner.size()) +
                                                            " corners cut into each other too often for a roof"
                                                      : "no roof that passes the check could be made";
        diagnostics_.push_back({{}, 0, 0, footprint_.id, why + ": left out", false});
        return false;
    }

    // By their numbers in the outline that was mended.
    std::vector<EdgeRoof> ownEdges() const {
        std::vector<EdgeRoof> own;
        for (uint32_t e = 0; e < outline_.sourceEdges.size(); ++e)
            for (const EdgeRoof& given : footprint_.edges)
                if (given.edge == outline_.sourceEdges[e]) own.push_back({e, given.gable, given.slope});
        return own;
    }

    // Where a designer wants a shed's eave.
    std::optional<uint32_t> lowEdge() const {
        for (uint32_t e = 0; e < outline_.sourceEdges.size(); ++e)
            for (const EdgeRoof& given : footprint_.edges)
                if (given.edge == outline_.sourceEdges[e] && given.gable && !*given.gable) return e;
        return {};
    }

    // What edges ask for that the shape has no use for.
    void nameUnused(RoofShape shape) {
        const auto asks = [&](const EdgeRoof& e) {
            return shape == RoofShape::flat ? e.gable || e.slope : e.slope || (e.gable && *e.gable);
        };
        if (!std::ranges::any_of(footprint_.edges, asks)) return;
        if (shape == RoofShape::flat) planner_.say("a flat roof has neither gables nor pitches of single edges");
        if (shape == RoofShape::shed) planner_.say("a shed has neither gables nor pitches of single edges");
    }

    bool make(RoofShape shape, bool plain, RoofStructure& out) {
        if (shape == RoofShape::shed) {
            Facets facets = shedFacets(outline_.rings, lowEdge(), footprint_.direction, planner_.slopeOf(shape));
            cutFacets(facets);
            return finish(facets, shape, out);
        }
        return attempts_.attempt(planner_.planOf(shape, plain), [&](Facets& facets) {
            cutFacets(facets);
            return finish(facets, shape, out);
        });
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
        house.shape = shape;
        house.material = uint32_t(footprint_.material);
        house.colour = footprint_.colour;
        house.overhang = footprint_.overhang;
        house.chimneys = footprint_.chimneys;
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
            double whole = std::max(*f.height - base, 0.1);
            roof = std::min(roof, whole * kMostRoof);
            eave = base + whole - roof;
        }
        double most = ridge * kSteepestRoof;
        return {eave.value_or(base + 2 * kStorey),
                std::min(std::max(roof, ridge > 0 ? 0.01 : 0.0), std::max(most, 0.0))};
    }

    const Footprint& footprint_;
    const RepairedOutline& outline_;
    const OutlineEdges edges_;
    RoofAttempts attempts_;
    RoofPlanner planner_;
    std::vector<Diagnostic>& diagnostics_;
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
        addMessages(diagnostics, std::move(said[p]));
    }
    return out;
}

}  // namespace espalier
