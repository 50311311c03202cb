// Single houses of a town: what they are, and a designer's changes, which make one footprint's structure and atoms
// anew.
#include <algorithm>
#include <cmath>
#include <cstring>

#include "runtime/core/srgb.hpp"
#include "runtime/plugin/context.hpp"
#include "runtime/roof/shapes.hpp"

namespace espalier {
namespace {

RoofHouse* houseOf(const EspContext* context, uint32_t house) {
    if (!context || !context->town || house >= context->town->structure.houses.size()) return nullptr;
    return const_cast<RoofHouse*>(&context->town->structure.houses[house]);
}

bool finiteDef(const EspHouseDef& def) {
    if (!(def.slope >= 0 && def.slope < 100) || !(def.eaveHeight >= 0 && def.eaveHeight < 1000)) return false;
    for (uint32_t i = 0; i < def.edgeCount; ++i)
        if (!(def.edges[i].slope >= 0 && def.edges[i].slope < 100)) return false;
    for (uint32_t i = 0; def.corners && i < 2 * def.cornerCount; ++i)
        if (!std::isfinite(def.corners[i])) return false;
    return true;
}

// World x and z of a corner of a ring.
glm::vec2 cornerOf(const RoofHouse& house, glm::vec2 p) {
    return {float(house.origin.x + p.x), float(-house.origin.y - p.y)};
}

EspHouseEdge edgeOf(const EdgeRoof& e) {
    return {e.edge, e.gable ? int(*e.gable) : -1, e.slope ? float(*e.slope) : 0};
}

static_assert(uint32_t(RoofMaterial::tiles) == ESP_COVERING_TILES &&
              uint32_t(RoofMaterial::grass) == ESP_COVERING_GRASS &&
              uint32_t(RoofMaterial::plainTiles) == ESP_COVERING_PLAIN_TILES &&
              uint32_t(RoofMaterial::barrelTiles) == ESP_COVERING_BARREL_TILES);

bool lookFits(const EspHouseLook& look) {
    const auto share = [](float c) { return c >= 0 && c <= 1; };
    return isAmong(look.covering, ESP_COVERING_ANY, ESP_COVERING_BARREL_TILES) &&
           isAmong(look.chimneys, ESP_CHIMNEYS_ANY, ESP_CHIMNEYS_ALL) && share(look.overhang) &&
           (!look.coloured || std::ranges::all_of(look.colour, share));
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

// Rings are made of the corners, all of them.
bool ringsFit(const EspHouseDef& def) {
    if (def.ringCount == 0) return true;
    if (!def.rings || !def.corners || def.ringCount > kMostCorners) return false;
    uint64_t sum = 0;
    for (uint32_t r = 0; r < def.ringCount; ++r) {
        if (def.rings[r] < 3) return false;
        sum += def.rings[r];
    }
    return sum == def.cornerCount;
}

const Footprint& footprintOf(const LoadedTown& town, uint32_t house) {
    const auto changed = town.changedHouses.find(house);
    return changed == town.changedHouses.end() ? town.footprints[town.footprintOf[house]] : changed->second;
}

// Which it is of the houses that its footprint, as it was loaded, makes.
size_t partOf(const LoadedTown& town, uint32_t house) {
    size_t part = 0;
    while (house > part && town.footprintOf[house - part - 1] == town.footprintOf[house]) ++part;
    return part;
}

// Whether all but its look is what it is already: then heights that its plan gives it stay.
bool standsAs(const Footprint& from, const RoofHouse& house, const EspHouseDef& def) {
    const float slope = from.slope ? float(*from.slope) : 0;
    if (def.shape != EspRoofShape(from.shape) || def.slope != slope || def.edgeCount != house.edges.size())
        return false;
    if (def.eaveHeight != 0 && def.eaveHeight != house.eaveHeight - house.baseHeight) return false;
    for (uint32_t i = 0; i < def.edgeCount; ++i) {
        const EspHouseEdge now = edgeOf(house.edges[i]), &edge = def.edges[i];
        if (edge.edge != now.edge || edge.gable != now.gable || edge.slope != now.slope) return false;
    }
    if (!def.corners) return true;
    if (def.ringCount != (def.ringCount > 0 ? house.rings.size() : 0)) return false;
    const float* corner = def.corners;
    for (size_t r = 0; r < (def.ringCount > 0 ? house.rings.size() : 1); ++r) {
        const size_t count = def.ringCount > 0 ? def.rings[r] : def.cornerCount;
        if (count != house.rings[r].size()) return false;
        for (glm::vec2 p : house.rings[r]) {
            const glm::vec2 at = cornerOf(house, p);
            if (*corner++ != at.x || *corner++ != at.y) return false;
        }
    }
    return true;
}

// The house's footprint with the changes of `def`. Its outline is the one that stands, by which callers count edges;
// world x and z are plan x and -y.
Footprint changed(const Footprint& from, const RoofHouse& house, const EspHouseDef& def) {
    Footprint f = from;
    if (def.look) takeLook(*def.look, f);
    if (standsAs(from, house, def)) return f;
    f.shape = RoofShape(def.shape);
    f.roofHeight.reset();
    f.slope.reset();
    if (def.slope > 0) f.slope = def.slope;
    if (def.eaveHeight > 0 || f.height) {
        // Heights to the ridge depend on the roof; walls shall stay what they are.
        const double walls = def.eaveHeight > 0 ? def.eaveHeight : house.eaveHeight - house.baseHeight;
        f.height.reset();
        f.levels = walls / 3.0;
    }
    f.edges.clear();
    for (uint32_t i = 0; i < def.edgeCount; ++i) {
        EdgeRoof e{def.edges[i].edge, {}, {}};
        if (def.edges[i].gable >= 0) e.gable = def.edges[i].gable != 0;
        if (def.edges[i].slope > 0) e.slope = def.edges[i].slope;
        f.edges.push_back(e);
    }
    f.rings.clear();
    for (const auto& ring : house.rings)
        for (f.rings.emplace_back(); glm::vec2 p : ring) f.rings.back().push_back(house.origin + glm::dvec2(p));
    if (!def.corners) return f;
    if (def.ringCount > 0) f.rings.assign(def.ringCount, {});
    const float* corner = def.corners;
    for (uint32_t r = 0; r < std::max(def.ringCount, 1u); ++r) {
        f.rings[r].clear();
        const uint32_t count = def.ringCount > 0 ? def.rings[r] : def.cornerCount;
        for (uint32_t i = 0; i < count; ++i, corner += 2) f.rings[r].emplace_back(corner[0], -corner[1]);
    }
    return f;
}

// Why a footprint makes no house, without what becomes of one that is loaded.
std::string causeOf(const std::vector<Diagnostic>& diagnostics) {
    constexpr std::string_view kLeftOut = ": left out";
    const auto error = std::ranges::find(diagnostics, false, &Diagnostic::warning);
    if (error == diagnostics.end()) return "no roof could be made";
    std::string cause = error->message;
    if (cause.ends_with(kLeftOut)) cause.resize(cause.size() - kLeftOut.size());
    return cause;
}

void replaceHouse(LoadedTown& town, uint32_t index, const RoofStructure& made, size_t part) {
    RoofStructure one;
    one.faces = made.faces;
    one.segments = made.segments;
    one.houses = {made.houses[part]};
    replaceAtoms(town.tables, index, one);
    RoofHouse& house = town.structure.houses[index];
    const uint32_t firstFace = house.firstFace, faceCount = house.faceCount;
    house = made.houses[part];
    house.firstFace = firstFace;  // the town's faces are what it was loaded with; atoms hold what counts
    house.faceCount = faceCount;
    town.changed.push_back(index);
    town.revision += 1;
}

EspResult setHouse(EspContext& context, uint32_t index, const Footprint& footprint) {
    RoofStructure made;
    std::vector<Diagnostic> diagnostics;
    appendRoof(footprint, made, diagnostics);
    if (made.houses.empty())
        return fail(&context, ESP_INVALID_CONTENT,
                    footprint.id + ": " + causeOf(diagnostics) + "; it stands as it did");
    LoadedTown& town = *context.town;
    // What is loaded may make several houses, each of which has a look of its own.
    const bool asLoaded = footprint.rings == town.footprints[town.footprintOf[index]].rings;
    const size_t part = asLoaded ? partOf(town, index) : 0;
    if ((made.houses.size() > 1 && !asLoaded) || part >= made.houses.size())
        return fail(&context, ESP_INVALID_CONTENT,
                    footprint.id + ": the outline crosses or touches itself, so that the house would fall into " +
                        std::to_string(made.houses.size()) + " parts; it stands as it did");
    town.changedHouses.insert_or_assign(index, footprint);
    replaceHouse(town, index, made, part);
    return ESP_OK;
}

EspResult resetHouse(EspContext& context, uint32_t index) {
    LoadedTown& town = *context.town;
    if (town.changedHouses.erase(index) == 0) return ESP_OK;
    RoofStructure made;
    std::vector<Diagnostic> ignored;  // told when the town was loaded
    appendRoof(footprintOf(town, index), made, ignored);
    replaceHouse(town, index, made, partOf(town, index));
    return ESP_OK;
}

}  // namespace
}  // namespace espalier

using namespace espalier;

extern "C" {

uint32_t espHouseCount(const EspContext* context) {
    return context && context->town ? uint32_t(context->town->structure.houses.size()) : 0;
}

EspResult espHouseInfo(const EspContext* context, uint32_t index, EspHouseInfo* out) {
    return guarded(context, [&] {
        const RoofHouse* house = houseOf(context, index);
        if (!house || !out) return fail(context, ESP_INVALID_ARGUMENT, "espHouseInfo: no such house, or null");
        const Footprint& footprint = footprintOf(*context->town, index);
        *out = EspHouseInfo{};
        out->id = house->id.c_str();
        out->note = house->note.c_str();
        out->shape = EspRoofShape(footprint.shape);
        out->slope = footprint.slope ? float(*footprint.slope) : 0;
        out->baseHeight = house->baseHeight;
        out->eaveHeight = house->eaveHeight;
        out->ridgeHeight = house->ridgeHeight;
        out->edgeCount = uint32_t(house->edges.size());
        out->ringCount = uint32_t(house->rings.size());
        out->look = lookOf(*house);
        glm::vec2 low(1e30f), high(-1e30f);
        for (const auto& ring : house->rings)
            for (glm::vec2 p : ring) {
                low = glm::min(low, p);
                high = glm::max(high, p);
                out->cornerCount += 1;
            }
        const glm::vec3 corner(float(house->origin.x + low.x), house->baseHeight, float(-house->origin.y - high.y));
        const glm::vec3 other(float(house->origin.x + high.x), house->ridgeHeight, float(-house->origin.y - low.y));
        std::memcpy(out->boundsMin, &corner, sizeof corner);
        std::memcpy(out->boundsMax, &other, sizeof other);
        return ESP_OK;
    });
}

EspResult espHouseShape(const EspContext* context, uint32_t index, float* corners, EspHouseEdge* edges) {
    return guarded(context, [&] {
        const RoofHouse* house = houseOf(context, index);
        if (!house) return fail(context, ESP_INVALID_ARGUMENT, "espHouseShape: no such house");
        for (const auto& ring : house->rings)
            for (glm::vec2 p : ring) {
                if (!corners) break;
                const glm::vec2 at = cornerOf(*house, p);
                *corners++ = at.x;
                *corners++ = at.y;
            }
        for (const EdgeRoof& e : house->edges)
            if (edges) *edges++ = edgeOf(e);
        return ESP_OK;
    });
}

EspResult espHouseRings(const EspContext* context, uint32_t index, uint32_t* corners) {
    return guarded(context, [&] {
        const RoofHouse* house = houseOf(context, index);
        if (!house || !corners) return fail(context, ESP_INVALID_ARGUMENT, "espHouseRings: no such house, or null");
        for (const auto& ring : house->rings) *corners++ = uint32_t(ring.size());
        return ESP_OK;
    });
}

EspResult espSetHouse(EspContext* context, uint32_t index, const EspHouseDef* def) {
    return guarded(context, [&] {
        if (!houseOf(context, index) || !def)
            return fail(context, ESP_INVALID_ARGUMENT, "espSetHouse: no such house, or null");
        if (!isAmong(def->shape, ESP_ROOF_HIP, ESP_ROOF_FLAT) || (def->edgeCount && !def->edges) ||
            (def->corners && def->cornerCount < 3) || def->cornerCount > kMostCorners ||
            def->edgeCount > kMostCorners || !finiteDef(*def) || !ringsFit(*def) ||
            (def->look && !lookFits(*def->look)))
            return fail(context, ESP_INVALID_ARGUMENT, "espSetHouse: a value out of its range");
        const Footprint& now = footprintOf(*context->town, index);
        return setHouse(*context, index, changed(now, *houseOf(context, index), *def));
    });
}

EspResult espResetHouse(EspContext* context, uint32_t index) {
    return guarded(context, [&] {
        if (!houseOf(context, index)) return fail(context, ESP_INVALID_ARGUMENT, "espResetHouse: no such house");
        return resetHouse(*context, index);
    });
}

}  // extern "C"
