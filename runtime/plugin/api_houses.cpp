// Single houses of a town: what they are, and a designer's changes, which make one footprint's structure and atoms
// anew.
#include <algorithm>
#include <cmath>
#include <cstring>

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

// The footprint with the changes of `def`; world x and z are plan x and -y.
Footprint changed(const Footprint& from, const RoofHouse& house, const EspHouseDef& def) {
    Footprint f = from;
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
    if (def.corners) {
        f.rings.front().clear();
        for (uint32_t i = 0; i < def.cornerCount; ++i)
            f.rings.front().emplace_back(def.corners[2 * i], -def.corners[2 * i + 1]);
    }
    return f;
}

// Another footprint for the house, and for what else was made of the same one.
EspResult rebuild(EspContext& context, uint32_t index, const Footprint& footprint) {
    LoadedTown& town = *context.town;
    const uint32_t number = town.footprintOf[index];
    std::vector<uint32_t> siblings;
    for (uint32_t i = 0; i < town.footprintOf.size(); ++i)
        if (town.footprintOf[i] == number) siblings.push_back(i);
    RoofStructure made;
    std::vector<Diagnostic> diagnostics;
    appendRoof(footprint, made, diagnostics);
    if (made.houses.size() > siblings.size())
        return fail(&context, ESP_INVALID_CONTENT,
                    footprint.id + ": the outline crosses or touches itself, so that the house would fall into " +
                        std::to_string(made.houses.size()) + " parts; it stands as it did");
    if (made.houses.size() < siblings.size()) return fail(&context, ESP_INVALID_CONTENT, toString(diagnostics));
    town.planned.try_emplace(number, town.footprints[number]);
    town.footprints[number] = footprint;
    for (size_t i = 0; i < siblings.size(); ++i) {
        RoofStructure one;
        one.faces = made.faces;
        one.segments = made.segments;
        one.houses = {made.houses[i]};
        replaceAtoms(town.tables, siblings[i], one);
        RoofHouse& house = town.structure.houses[siblings[i]];
        const uint32_t firstFace = house.firstFace, faceCount = house.faceCount;
        house = made.houses[i];
        house.firstFace = firstFace;  // the town's faces are what it was loaded with; atoms hold what counts
        house.faceCount = faceCount;
        town.changed.push_back(siblings[i]);
    }
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
        const Footprint& footprint = context->town->footprints[context->town->footprintOf[index]];
        *out = EspHouseInfo{};
        out->id = house->id.c_str();
        out->shape = EspRoofShape(house->shape);
        out->slope = footprint.slope ? float(*footprint.slope) : 0;
        out->baseHeight = house->baseHeight;
        out->eaveHeight = house->eaveHeight;
        out->ridgeHeight = house->ridgeHeight;
        out->edgeCount = uint32_t(footprint.edges.size());
        out->outerCorners = uint32_t(house->rings.front().size());
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
                *corners++ = float(house->origin.x + p.x);
                *corners++ = float(-house->origin.y - p.y);
            }
        for (const EdgeRoof& e : context->town->footprints[context->town->footprintOf[index]].edges)
            if (edges) *edges++ = {e.edge, e.gable ? int(*e.gable) : -1, e.slope ? float(*e.slope) : 0};
        return ESP_OK;
    });
}

EspResult espSetHouse(EspContext* context, uint32_t index, const EspHouseDef* def) {
    return guarded(context, [&] {
        if (!houseOf(context, index) || !def)
            return fail(context, ESP_INVALID_ARGUMENT, "espSetHouse: no such house, or null");
        if (def->shape < ESP_ROOF_HIP || def->shape > ESP_ROOF_FLAT || (def->edgeCount && !def->edges) ||
            (def->corners && def->cornerCount < 3) || def->cornerCount > kMostCorners ||
            def->edgeCount > kMostCorners || !finiteDef(*def))
            return fail(context, ESP_INVALID_ARGUMENT, "espSetHouse: a value out of its range");
        const Footprint& now = context->town->footprints[context->town->footprintOf[index]];
        return rebuild(*context, index, changed(now, *houseOf(context, index), *def));
    });
}

EspResult espResetHouse(EspContext* context, uint32_t index) {
    return guarded(context, [&] {
        if (!houseOf(context, index)) return fail(context, ESP_INVALID_ARGUMENT, "espResetHouse: no such house");
        const auto planned = context->town->planned.find(context->town->footprintOf[index]);
        return planned == context->town->planned.end() ? ESP_OK : rebuild(*context, index, Footprint(planned->second));
    });
}

}  // extern "C"
