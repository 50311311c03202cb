// Towns: footprints become structures and atoms when they are loaded or changed, roofs when the host updates.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstring>

#include "runtime/emit/terminals.hpp"
#include "runtime/plugin/context.hpp"
#include "runtime/roof/shapes.hpp"

namespace espalier {

Status knowRoofMeshes(EspContext& context) {
    if (!context.roofMeshNames.empty()) return Done{};
    Result<TerminalData> meshes = readTerminals(context.roofMeshFile, {"none"});
    if (!meshes) return meshes.failure();
    for (const std::string& kind : meshes->kinds) context.roofMeshNames.push_back({kind, false});
    context.roofMeshes = std::move(*meshes);
    return Done{};
}

namespace {

constexpr size_t kMaxTextBytes = 512u << 20;
constexpr size_t kMaxWarnings = 200;  // told one by one

void tell(EspContext& context, const std::vector<Diagnostic>& all) {
    for (size_t i = 0; i < all.size() && i < kMaxWarnings; ++i) {
        Diagnostic d = all[i];
        d.warning = true;
        context.log(Severity::warning, toString(d));
    }
    if (all.size() > kMaxWarnings)
        context.log(Severity::warning,
                    std::to_string(all.size() - kMaxWarnings) + " further messages about footprints");
}

// The footprint where the def places it: the plan is turned about its origin, then moved.
void place(Footprint& f, const EspTownDef& def) {
    const double c = std::cos(double(def.turn)), s = std::sin(double(def.turn));
    for (auto& ring : f.rings)
        for (glm::dvec2& p : ring)
            p = {c * p.x - s * p.y + double(def.position[0]), s * p.x + c * p.y - double(def.position[2])};
    f.baseHeight += double(def.position[1]);
    if (f.height) *f.height += double(def.position[1]);
    if (f.direction) *f.direction -= double(def.turn);  // clockwise from north
}

// Ground lies a little below the walls' feet, so that a floor that a model brings along lies on it.
GroundLook groundUnder(const RoofStructure& structure, const EspTownDef& def) {
    GroundLook ground;
    ground.drawn = def.ground != 0;
    ground.height = structure.houses.front().baseHeight;
    for (const RoofHouse& house : structure.houses) ground.height = std::min(ground.height, house.baseHeight);
    ground.height -= 0.02f;
    ground.colour = {def.groundColour[0], def.groundColour[1], def.groundColour[2]};
    return ground;
}

Result<LoadedTown> prepare(EspContext& context, const EspTownDef& def) {
    LoadedTown town;
    town.name = def.name ? def.name : "town";
    Result<Town> read = parseFootprints(std::string(def.text, def.length), town.name);
    if (!read) return read.failure();
    const auto begin = std::chrono::steady_clock::now();
    std::vector<Diagnostic> diagnostics = std::move(read->diagnostics);
    town.footprints = std::move(read->footprints);
    for (uint32_t i = 0; i < town.footprints.size(); ++i) {
        place(town.footprints[i], def);
        appendRoof(town.footprints[i], town.structure, diagnostics);
        town.footprintOf.resize(town.structure.houses.size(), i);
    }
    town.tables = makeAtoms(town.structure);
    town.structureMs = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
    for (Diagnostic& d : diagnostics)
        if (d.file.empty()) d.file = town.name;
    tell(context, diagnostics);
    if (town.structure.houses.empty()) return Failure(town.name, "holds no building whose roof could be made");
    town.number = ++context.towns;
    town.layers = PlanLayers(town.structure);
    town.ground = groundUnder(town.structure, def);
    return town;
}

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

EspResult updateTown(EspContext& context) {
    if (!context.town || context.town->grammar == 0) return ESP_OK;
    LoadedTown& town = *context.town;
    const LoadedGrammar* grammar = context.grammars.find(town.grammar);
    if (!grammar) {  // destroyed: nothing grows any more
        town.grammar = 0;
        town.view = {};
        return ESP_OK;
    }
    if (context.roofBounds.empty()) {
        Result<std::vector<RoofMesh>> bounds = context.renderer->loadRoofMeshes(TerminalData(*context.roofMeshes));
        if (!bounds) return failGpu(&context, bounds.failure());
        context.roofBounds = std::move(*bounds);
    }
    if (!context.roofs) {
        auto made = RoofGrowth::create(*context.device);
        if (!made) return failGpu(&context, made.failure());
        context.roofs = std::move(*made);
    }
    RoofInputs inputs;
    inputs.town = &town.tables;
    inputs.townRevision = town.number;
    inputs.grammar = &grammar->map;
    inputs.grammarRevision = grammar->revision;
    inputs.meshes = context.roofBounds;
    const bool painted = bindTownLayers(context, inputs);
    Status grown = Done{};
    if (town.stale || town.grammarRevision != grammar->revision)
        grown = context.roofs->grow(inputs);
    else if (!town.changed.empty())
        grown = context.roofs->growHouses(inputs, town.changed);
    else if (painted)
        grown = context.roofs->showLayers(inputs);
    if (!grown && grown.failure().diagnostics.front().file == "roofs")
        return fail(&context, ESP_INVALID_CONTENT, grown.failure().text());
    if (!grown) return failGpu(&context, grown.failure());
    town.stale = false;
    town.changed.clear();
    town.grammarRevision = grammar->revision;
    town.view = context.roofs->view();
    return ESP_OK;
}

}  // namespace espalier

using namespace espalier;

extern "C" {

EspTownDef espDefaultTownDef(void) {
    EspTownDef def{};
    def.ground = 1;
    def.groundColour[0] = .085f;
    def.groundColour[1] = .105f;
    def.groundColour[2] = .045f;
    return def;
}

EspResult espSetTownGrammar(EspContext* context, EspGrammar id) {
    return guarded(context, [&] {
        const LoadedGrammar* grammar = context->grammars.find(id.id);
        if (!context->town) return fail(context, ESP_INVALID_ARGUMENT, "espSetTownGrammar: there is no town");
        if (!grammar) return fail(context, ESP_INVALID_ARGUMENT, "espSetTownGrammar: no such grammar");
        if (!grammar->map.roofs())
            return fail(context, ESP_INVALID_ARGUMENT,
                        grammar->name + ": makes no roofs; a town needs a grammar with Extrude, Join, Split ...");
        context->town->grammar = id.id;
        context->town->stale = true;
        return ESP_OK;
    });
}

EspResult espLoadTown(EspContext* context, const EspTownDef* def) {
    return guarded(context, [&] {
        if (!def || !def->text) return fail(context, ESP_INVALID_ARGUMENT, "espLoadTown: null pointer");
        if (def->length > kMaxTextBytes)
            return fail(context, ESP_INVALID_CONTENT, "espLoadTown: more than 512 MiB of text");
        for (float v : {def->position[0], def->position[1], def->position[2], def->turn, def->groundColour[0],
                        def->groundColour[1], def->groundColour[2]})
            if (!(std::abs(v) < 1e6f)) return fail(context, ESP_INVALID_ARGUMENT, "espLoadTown: not a number");
        if (def->grammar.id) {
            const LoadedGrammar* grammar = context->grammars.find(def->grammar.id);
            if (!grammar || !grammar->map.roofs())
                return fail(context, ESP_INVALID_ARGUMENT, "espLoadTown: no such grammar, or one that makes no roofs");
        }
        if (Status known = knowRoofMeshes(*context); !known) return failContent(context, known.failure());
        Result<LoadedTown> town = prepare(*context, *def);
        if (!town) return failContent(context, town.failure());
        town->grammar = def->grammar.id;
        context->town = std::move(*town);
        return ESP_OK;
    });
}

EspResult espRemoveTown(EspContext* context) {
    return guarded(context, [&] {
        context->town.reset();
        return ESP_OK;
    });
}

EspResult espTownGrammar(const EspContext* context, EspGrammar* out) {
    return guarded(context, [&] {
        if (!out || !context->town) return fail(context, ESP_INVALID_ARGUMENT, "espTownGrammar: null, or no town");
        out->id = context->town->grammar;
        return ESP_OK;
    });
}

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

EspResult espReadRoofStats(EspContext* context, EspRoofStats* out) {
    return guarded(context, [&] {
        if (!out) return fail(context, ESP_INVALID_ARGUMENT, "espReadRoofStats: null pointer");
        *out = EspRoofStats{};
        if (!context->town) return ESP_OK;
        context->device->collect();
        const RoofStats grown = context->roofs ? context->roofs->stats() : RoofStats{};
        const RoofDrawStats drawn = context->renderer->stats().roofs;
        out->houses = uint32_t(context->town->structure.houses.size());
        out->eaves = grown.atoms;
        out->tiles = grown.tiles;
        out->clippedTiles = grown.clipped;
        out->grids = grown.grids;
        out->drawnTiles = drawn.tiles + drawn.cutTiles;
        out->drawnRectangles = drawn.rectangles;
        out->drawnTriangles = drawn.triangles;
        out->stopped = grown.stopped;
        out->housesGrown = grown.housesGrown;
        out->overflow = drawn.overflow;
        out->bytes = grown.bytes;
        out->structureMs = context->town->structureMs;
        out->expandMs = grown.expandMs;
        out->hash = grown.hash;
        return ESP_OK;
    });
}

}  // extern "C"
