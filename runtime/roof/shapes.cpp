// In: footprints. Out: structures that have passed the check. Each kind of roof is a plan for the wavefront
// (shapes_plan.hpp); only sheds, whose roof is one plane, are made without it.
#include "runtime/roof/shapes.hpp"

#include <algorithm>

#include "runtime/core/jobs.hpp"
#include "runtime/roof/check.hpp"
#include "runtime/roof/footprint_heights.hpp"
#include "runtime/roof/shapes_plan.hpp"
#include "runtime/roof/shapes_shed.hpp"

namespace espalier {

namespace {

class HouseMaker {
  public:
    HouseMaker(const Footprint& footprint, const RepairedOutline& outline, std::vector<Diagnostic>& diagnostics)
        : footprint_(footprint),
          outline_(outline),
          edges_(outline.rings),
          neighbours_(footprint.shared, outline.origin, edges_),
          planner_(footprint, outline, edges_, neighbours_, attempts_, diagnostics),
          diagnostics_(diagnostics) {}

    bool append(RoofStructure& out) {
        const size_t said = diagnostics_.size();
        if (!appendAny(out)) return false;
        RoofHouse& house = out.houses.back();
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
        planner_.nameUnusedRidge(shape);
        do
            if (make(shape, false, out)) return true;
        while (planner_.giveUpWish());
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

    // By their numbers in the outline that was mended and divided.
    std::vector<EdgeRoof> ownEdges(const DividedOutline& divided) const {
        std::vector<EdgeRoof> own;
        for (uint32_t e = 0; e < divided.edges.size(); ++e)
            for (const EdgeRoof& given : footprint_.edges)
                if (given.edge == outline_.sourceEdges[divided.edges[e]]) own.push_back({e, given.gable, given.slope});
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
        if (shape == RoofShape::shed) return makeShed(out);
        RoofPlan plan = planner_.planOf(shape, plain);
        SkeletonInput& input = plan.input;
        // Gables stay whole.
        const DividedOutline divided =
            neighbours_.divide(input.rings, [&](size_t e) { return !plan.level && input.speeds[e] == 0; });
        input.rings = divided.rings;
        for (std::vector<double>* speeds : {&input.speeds, &input.speedsAbove}) {
            if (speeds->empty()) continue;
            std::vector<double> whole = std::move(*speeds);
            speeds->clear();
            for (uint32_t e : divided.edges) speeds->push_back(whole[e]);
        }
        return attempts_.attempt(plan, [&](Facets& facets) {
            cutFacets(facets);
            return finish(facets, shape, divided, out);
        });
    }

    bool makeShed(RoofStructure& out) {
        std::vector<bool> closed;
        for (size_t e = 0; e < edges_.corner.size(); ++e) closed.push_back(neighbours_.closes(e));
        const uint32_t eave = shedEave(outline_.rings, lowEdge(), planner_.fallOf(), closed);
        const DividedOutline divided = neighbours_.divide(outline_.rings, [&](size_t e) { return e == eave; });
        const auto at = std::find(divided.edges.begin(), divided.edges.end(), eave);
        Facets facets =
            shedFacets(divided.rings, uint32_t(at - divided.edges.begin()), planner_.slopeOf(RoofShape::shed));
        cutFacets(facets);
        return finish(facets, RoofShape::shed, divided, out);
    }

    // Heights, then the check. What doesn't pass leaves no trace.
    bool finish(Facets& facets, RoofShape shape, const DividedOutline& divided, RoofStructure& out) {
        double ridge = 0;
        for (const Facets::Side& s : facets.sides)
            if (!s.dead) ridge = std::max(ridge, facets.points[s.from].z);
        const RoofHeights h = heightsOf(footprint_, ridge, planner_.slopeOf(shape));
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
        house.baseHeight = float(footprint_.ground + footprint_.baseHeight);
        house.eaveHeight = float(footprint_.ground + h.eave);
        house.open = footprint_.open;
        house.edges = ownEdges(divided);
        house.shape = shape;
        house.material = uint32_t(footprint_.material);
        house.colour = footprint_.colour;
        house.overhang = footprint_.overhang;
        house.chimneys = footprint_.chimneys;
        for (const Beside& b : divided.beside) {
            const double covered = std::max(b.top - footprint_.baseHeight, 0.0);
            house.shared.push_back(b.endsRoof ? kEndsRoof : float(covered));
        }
        for (const auto& ring : divided.rings) house.rings.emplace_back(ring.begin(), ring.end());
        size_t faces = out.faces.size(), segments = out.segments.size();
        appendHouse(facets, std::move(house), out);
        if (checkRoof(out, uint32_t(out.houses.size() - 1)).empty()) return true;
        out.houses.pop_back();
        out.faces.resize(faces);
        out.segments.resize(segments);
        return false;
    }

    const Footprint& footprint_;
    const RepairedOutline& outline_;
    const OutlineEdges edges_;
    const OutlineNeighbours neighbours_;
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
