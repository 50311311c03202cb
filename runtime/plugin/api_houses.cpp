// Single houses of a town: what they are, and a designer's changes (house_wish.hpp), which make one footprint's
// structure and atoms anew.
#include <algorithm>
#include <cmath>
#include <cstring>

#include "runtime/plugin/context.hpp"
#include "runtime/plugin/errors.hpp"
#include "runtime/plugin/given.hpp"
#include "runtime/plugin/house_wish.hpp"
#include "runtime/roof/shapes.hpp"

namespace espalier {
namespace {

RoofHouse* houseOf(const EspContext* context, uint32_t house) {
    if (!context || !context->town || house >= context->town->structure.houses.size()) return nullptr;
    return const_cast<RoofHouse*>(&context->town->structure.houses[house]);
}

static_assert(uint32_t(RoofShape::gable) == ESP_ROOF_GABLE && uint32_t(RoofShape::halfHip) == ESP_ROOF_HALF_HIP &&
              uint32_t(RoofShape::pyramid) == ESP_ROOF_PYRAMID && uint32_t(RoofShape::shed) == ESP_ROOF_SHED &&
              uint32_t(RoofShape::gambrel) == ESP_ROOF_GAMBREL && uint32_t(RoofShape::mansard) == ESP_ROOF_MANSARD &&
              uint32_t(RoofShape::flat) == ESP_ROOF_FLAT);
static_assert(uint32_t(RoofMaterial::tiles) == ESP_COVERING_TILES &&
              uint32_t(RoofMaterial::grass) == ESP_COVERING_GRASS &&
              uint32_t(RoofMaterial::plainTiles) == ESP_COVERING_PLAIN_TILES &&
              uint32_t(RoofMaterial::barrelTiles) == ESP_COVERING_BARREL_TILES);

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

const char* mistakeIn(const EspHouseLook& look) {
    const auto share = [](float c) { return c >= 0 && c <= 1; };
    if (!isAmong(look.covering, ESP_COVERING_ANY, ESP_COVERING_BARREL_TILES)) return "no such covering";
    if (!isAmong(look.chimneys, ESP_CHIMNEYS_ANY, ESP_CHIMNEYS_ALL)) return "chimneys are 0 to 2";
    if (!share(look.overhang)) return "the overhang must be within 0 to 1 m";
    if (look.coloured && !std::ranges::all_of(look.colour, share)) return "a colour must be within 0 to 1";
    return nullptr;
}

const char* mistakeIn(const EspHouseEdge& edge, uint32_t corners) {
    if (edge.edge >= corners) return "an edge is beyond the last";
    if (edge.gable < -1 || edge.gable > 1) return "an edge's gable is -1, 0 or 1";
    if (!(edge.slope >= 0 && edge.slope <= 100)) return "an edge's slope must be within 0 to 100";
    return nullptr;
}

// How many edges the house is to have: of the corners that are given, and of rings that stay.
uint32_t edgesAsked(const EspHouseDef& def, const RoofHouse& house) {
    uint32_t sum = def.corners ? def.cornerCount : 0;
    for (size_t r = 0; r < house.rings.size(); ++r)
        if (!def.corners || (def.ringCount == 0 && r > 0)) sum += uint32_t(house.rings[r].size());
    return sum;
}

const char* mistakeIn(const EspHouseDef& def, const RoofHouse& house) {
    if (!isAmong(def.shape, ESP_ROOF_HIP, ESP_ROOF_FLAT)) return "no such shape";
    if (!(def.slope >= 0 && def.slope <= 100)) return "the slope must be within 0 to 100";
    if (!(def.eaveHeight >= 0 && def.eaveHeight <= 1000)) return "the eaves' height must be within 0 to 1000 m";
    if (def.corners && (def.cornerCount < 3 || def.cornerCount > kMostCorners))
        return "an outline has 3 to 65536 corners";
    if (!ringsFit(def)) return "the rings aren't made of all corners, three or more each";
    for (uint32_t i = 0; def.corners && i < 2 * def.cornerCount; ++i)
        if (!std::isfinite(def.corners[i])) return "a corner is not finite";
    if (def.edgeCount && !def.edges) return "the edges are null";
    if (def.edgeCount > kMostCorners) return "more than 65536 edges";
    for (uint32_t i = 0; i < def.edgeCount; ++i)
        if (const char* mistake = mistakeIn(def.edges[i], edgesAsked(def, house))) return mistake;
    return def.look ? mistakeIn(*def.look) : nullptr;
}

const Footprint& footprintOf(const LoadedTown& town, uint32_t house) {
    const auto changed = town.changedHouses.find(house);
    return changed == town.changedHouses.end() ? town.footprints[town.footprintOf[house]] : changed->second.footprint;
}

// As its plan has it.
const RoofHouse& plannedHouse(const LoadedTown& town, uint32_t house) {
    const auto changed = town.changedHouses.find(house);
    return changed == town.changedHouses.end() ? town.structure.houses[house] : changed->second.planned;
}

// Which it is of the houses that its footprint, as it was loaded, makes.
size_t partOf(const LoadedTown& town, uint32_t house) {
    size_t part = 0;
    while (house > part && town.footprintOf[house - part - 1] == town.footprintOf[house]) ++part;
    return part;
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

void replaceHouse(EspContext& context, uint32_t index, const RoofStructure& made, size_t part) {
    LoadedTown& town = *context.town;
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
    context.nodes.town.change();
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
    std::map<uint32_t, ChangedHouse> changed{{index, ChangedHouse{footprint, RoofHouse(plannedHouse(town, index))}}};
    replaceHouse(context, index, made, part);
    town.changedHouses.erase(index);
    town.changedHouses.merge(changed);  // takes no memory
    return ESP_OK;
}

EspResult resetHouse(EspContext& context, uint32_t index) {
    LoadedTown& town = *context.town;
    if (!town.changedHouses.count(index)) return ESP_OK;
    RoofStructure made;
    std::vector<Diagnostic> ignored;  // told when the town was loaded
    appendRoof(town.footprints[town.footprintOf[index]], made, ignored);
    replaceHouse(context, index, made, partOf(town, index));
    town.changedHouses.erase(index);
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
        if (!house) return fail(context, ESP_INVALID_ARGUMENT, "espHouseInfo: no such house");
        const Footprint& footprint = footprintOf(*context->town, index);
        EspHouseInfo info{};
        info.id = house->id.c_str();
        info.note = house->note.c_str();
        info.shape = EspRoofShape(footprint.shape);
        info.slope = footprint.slope ? float(*footprint.slope) : 0;
        info.baseHeight = house->baseHeight;
        info.eaveHeight = house->eaveHeight;
        info.ridgeHeight = house->ridgeHeight;
        info.edgeCount = uint32_t(house->edges.size());
        info.ringCount = uint32_t(house->rings.size());
        info.hidden = context->town->tables.houses[index].hidden ? 1 : 0;
        glm::vec2 low(1e30f), high(-1e30f);
        for (const auto& ring : house->rings)
            for (glm::vec2 p : ring) {
                low = glm::min(low, p);
                high = glm::max(high, p);
                info.cornerCount += 1;
            }
        const glm::vec3 corner(float(house->origin.x + low.x), house->baseHeight, float(-house->origin.y - high.y));
        const glm::vec3 other(float(house->origin.x + high.x), house->ridgeHeight, float(-house->origin.y - low.y));
        std::memcpy(info.boundsMin, &corner, sizeof corner);
        std::memcpy(info.boundsMax, &other, sizeof other);
        give("espHouseInfo", out, info);
        return ESP_OK;
    });
}

EspResult espHouseLook(const EspContext* context, uint32_t index, EspHouseLook* out) {
    return guarded(context, [&] {
        const RoofHouse* house = houseOf(context, index);
        if (!house) return fail(context, ESP_INVALID_ARGUMENT, "espHouseLook: no such house");
        give("espHouseLook", out, lookOf(*house));
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
                const glm::vec2 at = worldCorner(*house, p);
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

EspResult espSetHouse(EspContext* context, uint32_t index, const EspHouseDef* given) {
    return guarded(context, [&] {
        EspHouseDef def = taken("espSetHouse", given);
        if (!houseOf(context, index)) return fail(context, ESP_INVALID_ARGUMENT, "espSetHouse: no such house");
        const EspHouseLook look = takenOr("espSetHouse", def.look, EspHouseLook{});
        if (def.look) def.look = &look;
        if (const char* mistake = mistakeIn(def, *houseOf(context, index)))
            return fail(context, ESP_INVALID_ARGUMENT, std::string("espSetHouse: ") + mistake);
        const LoadedTown& town = *context->town;
        const HouseWish wish = wishOf(town.structure.houses[index], def);
        return setHouse(*context, index,
                        footprintFor(town.footprints[town.footprintOf[index]], plannedHouse(town, index), wish));
    });
}

EspResult espResetHouse(EspContext* context, uint32_t index) {
    return guarded(context, [&] {
        if (!houseOf(context, index)) return fail(context, ESP_INVALID_ARGUMENT, "espResetHouse: no such house");
        return resetHouse(*context, index);
    });
}

EspResult espHideHouse(EspContext* context, uint32_t index, int hidden) {
    return guarded(context, [&] {
        if (!houseOf(context, index)) return fail(context, ESP_INVALID_ARGUMENT, "espHideHouse: no such house");
        RoofTables::House& house = context->town->tables.houses[index];
        if (house.hidden == (hidden != 0)) return ESP_OK;
        context->town->changed.push_back(index);
        house.hidden = hidden != 0;
        context->nodes.town.change();
        return ESP_OK;
    });
}

}  // extern "C"
