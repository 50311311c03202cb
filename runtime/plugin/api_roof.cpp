// Towns: footprints become structures and atoms when they are loaded or changed, roofs when the host updates.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstring>

#include "runtime/emit/terminals.hpp"
#include "runtime/plugin/context.hpp"
#include "runtime/plugin/errors.hpp"
#include "runtime/plugin/given.hpp"
#include "runtime/plugin/town_growth.hpp"
#include "runtime/roof/shapes.hpp"
#include "runtime/roof_growth/house_tables.hpp"

namespace espalier {

EspResult knowRoofMeshes(EspContext& context, std::string& why) {
    if (!context.roofMeshNames.empty()) return ESP_OK;
    const std::string path = context.roofMeshFile.string();
    const Result<std::vector<std::byte>> file = context.files.read(path);
    if (!file) {
        why = file.failure().text();
        return ESP_IO_FAILED;
    }
    Result<TerminalData> meshes = parseTerminals(file.value(), path, {"none"});
    if (!meshes) {
        why = meshes.failure().text();
        return ESP_INVALID_CONTENT;
    }
    std::vector<TerminalMesh> names;
    for (const std::string& kind : meshes->kinds) names.push_back({kind, false});
    context.roofMeshNames = std::move(names);
    context.roofMeshes = std::move(*meshes);
    return ESP_OK;
}

namespace {

constexpr size_t kMaxFootprintBytes = 512u << 20;
constexpr size_t kMaxWarnings = 200;  // told one by one

void tell(const EspContext& context, const std::vector<Diagnostic>& all) {
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
    const auto turn = [&](glm::dvec2& p) {
        p = {c * p.x - s * p.y + double(def.position[0]), s * p.x + c * p.y - double(def.position[2])};
    };
    for (auto& ring : f.rings)
        for (glm::dvec2& p : ring) turn(p);
    for (SharedWall& wall : f.shared) turn(wall.from), turn(wall.to);
    f.ground = double(def.position[1]);
    if (f.direction) *f.direction -= double(def.turn);  // clockwise from north
}

// Ground lies a little below the walls' feet, so that a floor that a model brings along lies on it.
GroundLook groundUnder(const RoofStructure& structure, const EspTownDef& def) {
    GroundLook ground;
    ground.kind = def.ground != 0 ? GroundKind::meadow : GroundKind::none;
    ground.height = structure.houses.front().baseHeight;
    for (const RoofHouse& house : structure.houses) ground.height = std::min(ground.height, house.baseHeight);
    ground.height -= 0.02f;
    ground.colour = vec(def.groundColour);
    return ground;
}

Result<LoadedTown> prepare(const EspContext& context, const EspTownDef& def) {
    LoadedTown town;
    town.name = def.name ? def.name : "town";
    Result<Town> read = parseFootprints(std::string(def.text, def.length), town.name);
    if (!read) return read.failure();
    const auto begin = std::chrono::steady_clock::now();
    std::vector<Diagnostic> diagnostics = std::move(read->diagnostics);
    town.footprints = std::move(read->footprints);
    town.origin = read->origin;
    town.geographic = read->geographic;
    for (uint32_t i = 0; i < town.footprints.size(); ++i) {
        place(town.footprints[i], def);
        std::vector<Diagnostic> said;
        appendRoof(town.footprints[i], town.structure, said);
        addMessages(diagnostics, std::move(said));
        town.footprintOf.resize(town.structure.houses.size(), i);
    }
    town.tables = makeAtoms(town.structure);
    town.structureMs = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
    for (Diagnostic& d : diagnostics)
        if (d.file.empty()) d.file = town.name;
    tell(context, diagnostics);
    if (town.structure.houses.empty()) return Failure(town.name, "holds no building whose roof could be made");
    town.number = town.tablesMade = nextVersion();
    town.layers = PlanLayers(town.structure);
    town.ground = groundUnder(town.structure, def);
    return town;
}

// Grows what the town's inputs ask for.
EspResult growTown(EspContext& context, const LoadedGrammar& grammar) {
    LoadedTown& town = *context.town;
    if (!town.changed.empty() && mostlyUnused(town.tables)) {
        town.tables = withoutUnused(town.tables);
        town.tablesMade = town.whole = context.nodes.town.change();
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
    inputs.townRevision = town.tablesMade;
    inputs.grammar = &grammar.map;
    inputs.grammarRevision = grammar.version;
    inputs.meshes = context.roofBounds;
    inputs.native = !context.grow.shadersOnly;
    bindTownLayers(context, inputs);
    std::vector<ContextInfo> contexts = grammar.map.contexts();
    Status grown = Done{};
    const bool whole = town.growsWhole(grammar);
    if (whole)
        grown = context.roofs->grow(inputs);
    else if (!town.changed.empty())
        grown = context.roofs->growHouses(inputs, town.changed);
    else if (!town.painted.empty())
        grown = context.roofs->showLayers(inputs);
    if (!grown && grown.failure().ofDevice()) return failGpu(&context, grown.failure());
    if (!grown)
        return fail(&context, ESP_INVALID_CONTENT, grammar.name + ": " + grown.failure().diagnostics.front().message);
    const RoofView view = context.roofs->view();
    if (view.revision != town.view.revision) context.dropTriangles();
    context.nodes.roofs.made();
    town.stands(context.nodes.roofs.version(), whole);
    town.view = view;
    town.contexts = std::move(contexts);
    return ESP_OK;
}

EspRoofStats statsOf(const EspContext& context) {
    EspRoofStats stats{};
    const bool stand = context.roofs && context.town->view.gridCount > 0;
    const RoofStats grown = stand ? context.roofs->stats() : RoofStats{};
    const RoofDrawStats drawn = context.renderer->stats().roofs;
    stats.houses = uint32_t(context.town->structure.houses.size());
    stats.eaves = grown.atoms;
    stats.tiles = grown.tiles;
    stats.clippedTiles = grown.clipped;
    stats.grids = grown.grids;
    stats.drawnTiles = drawn.tiles + drawn.cutTiles;
    stats.drawnRectangles = drawn.rectangles;
    stats.drawnTriangles = drawn.triangles;
    stats.stopped = grown.stopped;
    stats.housesGrown = grown.housesGrown;
    stats.overflow = drawn.overflow;
    stats.bytes = grown.bytes;
    stats.structureMs = context.town->structureMs;
    stats.expandMs = grown.expandMs;
    stats.hash = grown.hash;
    return stats;
}

}  // namespace

void setDefaults(EspTownDef& def) {
    def.ground = 1;
    def.groundColour[0] = .085f;
    def.groundColour[1] = .105f;
    def.groundColour[2] = .045f;
}

EspResult updateTown(EspContext& context) {
    if (!context.town || context.town->grammar == 0) return ESP_OK;
    LoadedTown& town = *context.town;
    const LoadedGrammar* grammar = context.grammars.find(town.grammar);
    if (!grammar) {  // destroyed: nothing grows any more
        town.grammar = 0;
        town.view = {};
        return ESP_OK;
    }
    const graph::Node& roofs = context.nodes.roofs;
    if (!roofs.due()) return ESP_OK;
    if (!context.device->lost() && town.failed.known(roofs.version())) return town.failed.tell(context.error);
    const EspResult grown = grownOr(context, [&] { return growTown(context, *grammar); });
    return grown == ESP_OK ? town.failed.forget() : town.failed.note(roofs.version(), grown, context.error);
}

}  // namespace espalier

using namespace espalier;

extern "C" {

EspResult espDefaultTownDef(EspTownDef* out) {
    return giveDefaults("espDefaultTownDef", out);
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
        context->town->whole = context->nodes.town.change();
        return ESP_OK;
    });
}

EspResult espLoadTown(EspContext* context, const EspTownDef* given) {
    return guarded(context, [&] {
        const EspTownDef def = taken("espLoadTown", given);
        if (!def.text) return fail(context, ESP_INVALID_ARGUMENT, "espLoadTown: null pointer");
        if (def.length > kMaxFootprintBytes)
            return fail(context, ESP_INVALID_CONTENT, "espLoadTown: more than 512 MiB of text");
        for (float v : {def.position[0], def.position[1], def.position[2], def.turn, def.groundColour[0],
                        def.groundColour[1], def.groundColour[2]})
            if (!(std::abs(v) < 1e6f))
                return fail(context, ESP_INVALID_ARGUMENT,
                            "espLoadTown: position, turn and ground colour must be numbers within 1e6");
        if (def.grammar.id) {
            const LoadedGrammar* grammar = context->grammars.find(def.grammar.id);
            if (!grammar || !grammar->map.roofs())
                return fail(context, ESP_INVALID_ARGUMENT, "espLoadTown: no such grammar, or one that makes no roofs");
        }
        std::string why;
        if (const EspResult unknown = knowRoofMeshes(*context, why)) return fail(context, unknown, why);
        Result<LoadedTown> town = prepare(*context, def);
        if (!town) return failContent(context, town.failure());
        town->grammar = def.grammar.id;
        context->town = std::move(*town);
        context->town->whole = context->nodes.town.change();
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
        out->id = townGrammar(*context) ? context->town->grammar : 0;
        return ESP_OK;
    });
}

EspResult espReadRoofStats(EspContext* context, EspRoofStats* out) {
    return guarded(context, [&] {
        EspRoofStats stats{};
        if (context->town) {
            context->device->collect();
            stats = statsOf(*context);
        }
        give("espReadRoofStats", out, stats);
        return ESP_OK;
    });
}

}  // extern "C"
