// Enters: a plan's footprint, the house as it was planned, what a designer wants. Leaves: the footprint of that.
#include "runtime/plugin/house_wish.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "runtime/core/srgb.hpp"
#include "runtime/roof/footprint_heights.hpp"

namespace espalier {
namespace {

bool operator==(const EspHouseEdge& a, const EspHouseEdge& b) {
    return a.edge == b.edge && a.gable == b.gable && a.slope == b.slope;
}

void takeLook(const EspHouseLook& look, Footprint& f) {
    f.material = RoofMaterial(look.covering);
    f.colour = 0;
    for (int c = 0; look.coloured && c < 3; ++c)
        f.colour |= uint32_t(std::lround(255 * srgbOfLinear(look.colour[c]))) << (8 * c);
    if (look.coloured) f.colour |= 0xFF000000u;
    f.overhang = look.overhang;
    f.chimneys = uint32_t(look.chimneys);
}

std::vector<std::vector<glm::dvec2>> ringsOf(const RoofHouse& house) {
    std::vector<std::vector<glm::dvec2>> rings;
    for (const auto& ring : house.rings)
        for (rings.emplace_back(); glm::vec2 p : ring) rings.back().push_back(house.origin + glm::dvec2(p));
    return rings;
}

float wallsOf(const RoofHouse& house) {
    return house.eaveHeight - house.baseHeight;
}
float slopeOf(const Footprint& footprint) {
    return footprint.slope ? float(*footprint.slope) : 0;
}

// As callers can tell corners apart.
bool sameRings(const RoofHouse& house, const std::vector<std::vector<glm::dvec2>>& rings) {
    const auto same = [](glm::dvec2 a, glm::dvec2 b) { return glm::vec2(a) == glm::vec2(b); };
    return std::ranges::equal(ringsOf(house), rings,
                              [&](const auto& a, const auto& b) { return std::ranges::equal(a, b, same); });
}

// The pitches that edges have of their own; not which, since new corners give edges other numbers.
std::set<float> pitchesOf(const std::vector<EspHouseEdge>& edges) {
    std::set<float> pitches;
    for (const EspHouseEdge& e : edges)
        if (e.slope > 0) pitches.insert(e.slope);
    return pitches;
}
std::vector<EspHouseEdge> edgesOf(const RoofHouse& house) {
    std::vector<EspHouseEdge> edges;
    for (const EdgeRoof& e : house.edges) edges.push_back(edgeOf(e));
    return edges;
}
bool sameEdges(const std::vector<EspHouseEdge>& a, const std::vector<EspHouseEdge>& b) {
    return std::ranges::equal(a, b, [](const auto& x, const auto& y) { return x == y; });
}

// Whether nothing is asked of the roof's pitch that the plan doesn't say.
bool pitchStands(const Footprint& plan, const RoofHouse& planned, const HouseWish& wish) {
    return wish.shape == plan.shape && wish.slope == slopeOf(plan) &&
           pitchesOf(wish.edges) == pitchesOf(edgesOf(planned));
}

// Whether all but its look is as planned.
bool standsAsPlanned(const Footprint& plan, const RoofHouse& planned, const HouseWish& wish) {
    return wish.shape == plan.shape && wish.slope == slopeOf(plan) && wish.eaveHeight == wallsOf(planned) &&
           sameEdges(wish.edges, edgesOf(planned)) && sameRings(planned, wish.rings);
}

// Whether the plan's height, of which walls keep their share, leaves the roof less than its pitch asks for.
bool heightLimitsRoof(const Footprint& plan, const RoofHouse& planned) {
    const float roof = planned.ridgeHeight - planned.eaveHeight, whole = planned.ridgeHeight - planned.baseHeight;
    return plan.height && roof > whole * float(kMostRoof) - 1e-3f;
}

}  // namespace

glm::vec2 worldCorner(const RoofHouse& house, glm::vec2 corner) {
    return {float(house.origin.x + corner.x), float(-house.origin.y - corner.y)};
}

EspHouseEdge edgeOf(const EdgeRoof& e) {
    return {e.edge, e.gable ? int(*e.gable) : -1, e.slope ? float(*e.slope) : 0};
}

EspHouseLook lookOf(const RoofHouse& house) {
    EspHouseLook look{};
    look.covering = EspCovering(house.material);
    look.coloured = house.colour >> 24 != 0;
    for (int c = 0; look.coloured && c < 3; ++c)
        look.colour[c] = linearOfSrgb(float(house.colour >> (8 * c) & 255) / 255);
    look.overhang = house.overhang;
    look.chimneys = EspChimneys(house.chimneys);
    return look;
}

HouseWish wishOf(const RoofHouse& now, const EspHouseDef& def) {
    HouseWish wish{RoofShape(def.shape), def.slope, def.eaveHeight > 0 ? def.eaveHeight : wallsOf(now), {}, {}, {}};
    wish.edges.assign(def.edges, def.edges + def.edgeCount);
    std::ranges::stable_sort(wish.edges, {}, &EspHouseEdge::edge);
    wish.look = def.look ? *def.look : lookOf(now);
    wish.rings = ringsOf(now);
    if (!def.corners) return wish;
    if (def.ringCount > 0) wish.rings.assign(def.ringCount, {});
    const float* corner = def.corners;
    for (uint32_t r = 0; r < std::max(def.ringCount, 1u); ++r) {
        wish.rings[r].clear();
        const uint32_t count = def.ringCount > 0 ? def.rings[r] : def.cornerCount;
        for (uint32_t i = 0; i < count; ++i, corner += 2) wish.rings[r].emplace_back(corner[0], -corner[1]);
    }
    return wish;
}

Footprint footprintFor(const Footprint& plan, const RoofHouse& planned, const HouseWish& wish) {
    Footprint f = plan;
    takeLook(wish.look, f);
    if (standsAsPlanned(plan, planned, wish)) return f;
    f.shaped = f.shaped || wish.shape != plan.shape;
    f.shape = wish.shape;
    f.slope.reset();
    if (wish.slope > 0) f.slope = wish.slope;
    // Where the plan gives the roof a height, that stays until something is asked of its pitch: a dragged corner or
    // higher walls leave it as it is.
    f.roofHeight.reset();
    f.roofLevels.reset();
    const bool given = plan.roofHeight || (!plan.slope && (plan.roofLevels || (plan.height && plan.levels))) ||
                       heightLimitsRoof(plan, planned);
    if (given && pitchStands(plan, planned, wish)) f.roofHeight = planned.ridgeHeight - planned.eaveHeight;
    if (wish.eaveHeight != wallsOf(planned) || f.height) {
        // Heights to the ridge depend on the roof; walls shall stay what they are.
        f.height.reset();
        f.levels.reset();
        f.wallHeight = wish.eaveHeight;
    }
    f.edges.clear();
    for (const EspHouseEdge& edge : wish.edges) {
        EdgeRoof e{edge.edge, {}, {}};
        if (edge.gable >= 0) e.gable = edge.gable != 0;
        if (edge.slope > 0) e.slope = edge.slope;
        f.edges.push_back(e);
    }
    f.rings = wish.rings;
    return f;
}

}  // namespace espalier
