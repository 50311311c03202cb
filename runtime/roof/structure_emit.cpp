// In: clean, monotone facets. Out: faces and chains of structure.hpp, with the joints between them named.
#include <cmath>

#include "runtime/roof/structure_facets.hpp"

namespace espalier {

namespace {

// Real outlines are a little out of square, and so their ridges a little out of level: a ridge may rise this much of
// what the roof beside it falls (a square corner's hip rises as much).
constexpr double kRidgeRise = 0.25;

// How fast the facet's roof rises to the left of the direction.
double riseLeft(const Facets::Facet& facet, glm::dvec2 direction) {
    return facet.slope * glm::dot(facet.uphill, glm::dvec2(-direction.y, direction.x));
}

JointKind jointKind(const Facets& f, const Facets::Side& side, uint32_t to) {
    const Facets::Facet& here = f.facets[side.facet];
    if (side.twin == kNone) return JointKind::wall;
    const Facets::Facet& there = f.facets[f.sides[side.twin].facet];
    bool gableHere = here.kind == FaceKind::gable, gableThere = there.kind == FaceKind::gable;
    if (gableHere || gableThere) return gableHere && gableThere ? JointKind::wall : JointKind::verge;
    glm::dvec3 d = f.points[to] - f.points[side.from];
    double length = glm::length(glm::dvec2(d));
    if (glm::length(here.slope * here.uphill - there.slope * there.uphill) < 1e-6) return JointKind::cut;
    if (!(length > 0)) return JointKind::wall;
    glm::dvec2 direction = glm::dvec2(d) / length;
    double left = riseLeft(here, direction), right = -riseLeft(there, direction);
    double rise = std::abs(d.z) / length;
    if (left < 0 && right < 0 && rise <= kRidgeRise * std::min(-left, -right)) return JointKind::ridge;
    if (rise <= 1e-5 + 1e-5 / length && left * right <= 0) return JointKind::breakLine;
    return left + right < 0 ? JointKind::hip : JointKind::valley;
}

glm::vec3 placed(glm::dvec3 p, double eaveHeight) {
    return {float(p.x), float(eaveHeight + p.z), float(-p.y)};
}

}  // namespace

void appendHouse(const Facets& f, RoofHouse house, RoofStructure& out) {
    house.firstFace = uint32_t(out.faces.size());
    double eaveHeight = house.eaveHeight, top = 0;
    uint32_t houseIndex = uint32_t(out.houses.size());
    std::vector<uint32_t> faceOf(f.facets.size(), kNoFace), segmentOf(f.sides.size(), kNoFace);
    std::vector<uint32_t> sideOf;  // a new segment each
    uint32_t firstSegment = uint32_t(out.segments.size());
    for (uint32_t i = 0; i < f.facets.size(); i++) {
        const Facets::Facet& facet = f.facets[i];
        if (facet.side == kNone) continue;
        // The run of eave sides: the chain begins after it.
        uint32_t first = facet.side, s = first;
        do s = f.sides[s].next;
        while (s != first && !(f.sides[s].eave && !f.sides[f.sides[s].next].eave));
        bool detached = !f.sides[s].eave;
        glm::dvec3 eave[2] = {facet.eave[0], facet.eave[1]};
        uint32_t begin = f.sides[s].next, stop = begin;
        if (!detached) {
            eave[1] = f.points[f.sides[begin].from];
            stop = s;
            while (f.sides[f.sides[stop].previous].eave) stop = f.sides[stop].previous;
            eave[0] = f.points[f.sides[stop].from];
        }
        faceOf[i] = uint32_t(out.faces.size());
        RoofFace face{houseIndex,
                      facet.edge,
                      facet.tier,
                      facet.kind,
                      {placed(eave[0], eaveHeight), placed(eave[1], eaveHeight)},
                      float(facet.slope),
                      uint32_t(out.segments.size()),
                      0,
                      detached};
        uint32_t side = begin;
        do {
            segmentOf[side] = uint32_t(out.segments.size());
            sideOf.push_back(side);
            uint32_t to = f.to(side);
            top = std::max(top, f.points[to].z);
            out.segments.push_back(
                {placed(f.points[to], eaveHeight), kNoFace, kNoFace, jointKind(f, f.sides[side], to)});
            side = f.sides[side].next;
        } while (side != stop);
        face.segmentCount = uint32_t(out.segments.size()) - face.firstSegment;
        out.faces.push_back(face);
    }
    for (uint32_t i = 0; i < sideOf.size(); i++) {
        uint32_t twin = f.sides[sideOf[i]].twin;
        if (twin == kNone) continue;
        out.segments[firstSegment + i].face = faceOf[f.sides[twin].facet];
        out.segments[firstSegment + i].segment = segmentOf[twin];
    }
    house.ridgeHeight = float(eaveHeight + top);
    house.faceCount = uint32_t(out.faces.size()) - house.firstFace;
    out.houses.push_back(std::move(house));
}

}  // namespace espalier
