// Growing what has changed: seeds, grammars, layers and surfaces of a context become the inputs of growth.
#include <algorithm>
#include <cmath>
#include <map>

#include "runtime/plugin/context.hpp"
#include "runtime/plugin/errors.hpp"
#include "runtime/plugin/given.hpp"
#include "runtime/plugin/kept_paint.hpp"
#include "runtime/plugin/seeds.hpp"
#include "runtime/plugin/surface_contacts.hpp"
#include "runtime/plugin/surface_point.hpp"
#include "runtime/plugin/town_growth.hpp"

namespace espalier {
namespace {

// What has grown stands on these.
void noteSurfaces(EspContext& context) {
    if (context.nodes.carriers.due()) {
        std::vector<bool> carriers(context.surfaceSlots());
        context.seeds.forEach([&](uint32_t, const PlantedSeed& seed) {
            if (beginsPattern(context, seed) || isAway(context, seed)) return;
            carriers[instanceOf(seed.surface)] = true;
            if (seed.frozen)
                for (uint32_t instance : seed.frozenOn) carriers[instance] = true;
        });
        addReached(context, carriers);
        context.carriers = std::move(carriers);
        context.nodes.carriers.made();
    }
    context.grownSurfaces.assign(context.surfaceSlots(), {});
    context.surfaces.forEach([&](uint32_t id, const PlacedSurface& surface) {
        context.grownSurfaces[surface.instance] = {id, surface.toWorld, surface.placed};
    });
}

// The rule maps of growth: those of grammars, then those of variants.
struct Maps {
    std::vector<RuleMapRef> refs;
    std::vector<float> widths, avoid;
    std::vector<uint32_t> ids;             // of grammars; of variants their places: no grammar's id is so small
    std::map<uint32_t, uint32_t> indices;  // of grammars by their ids
    uint32_t firstVariant = 0;

    void add(const RuleMap& map, const Buffer& words, const std::vector<uint32_t>& layerOf) {
        RuleMapRef ref = map.refAt(words.address());
        if (map.kind() != GrammarKind::plants) {  // keeps its number, but growth has nothing to do with it
            ref = RuleMapRef{};
            ref.features = kFeatureKnown;
        }
        for (size_t i = 0; i < layerOf.size() && i < kMaxLayers; ++i) ref.layerOf[i] = layerOf[i];
        refs.push_back(ref);
        widths.push_back(map.width());
        avoid.push_back(map.avoid());
    }
};

Maps mapsOf(const EspContext& context) {
    Maps maps;
    context.grammars.forEach([&](uint32_t id, const LoadedGrammar& grammar) {
        maps.indices[id] = uint32_t(maps.ids.size());
        maps.ids.push_back(id);
        maps.add(grammar.map, grammar.words, grammar.layerOf);
    });
    maps.firstVariant = uint32_t(maps.ids.size());
    for (const GrammarVariant& variant : context.variants) {
        maps.ids.push_back(uint32_t(maps.ids.size()) - maps.firstVariant);
        maps.add(variant.map, variant.words, variant.layerOf);
    }
    return maps;
}

// What grows, and what stands frozen.
struct Planting {
    std::vector<Seed> seeds;
    std::vector<FrozenPlant> frozen;
    std::vector<uint32_t> ids;  // of seeds, then of frozen ones
};

Planting plantingOf(const EspContext& context, const Maps& maps) {
    Planting out;
    std::vector<uint32_t> frozenIds;
    context.seeds.forEach([&](uint32_t id, const PlantedSeed& planted) {
        if (beginsPattern(context, planted)) return;
        Seed seed{};
        seed.key = seedKey(planted);
        if (isAway(context, planted) || planted.hidden) return;
        if (planted.frozen) {
            out.frozen.push_back({seed.key, planted.frozen});
            frozenIds.push_back(id);
            return;
        }
        if (planted.onBare || buriedByOthers(context, planted)) return;
        seed.walk = planted.walk;
        seed.grammar =
            planted.variant == kNoIndex ? maps.indices.at(planted.grammar) : maps.firstVariant + planted.variant;
        const RuleMap& map = context.grammars.find(planted.grammar)->map;
        seed.symbol = planted.symbol.empty() ? map.startSymbol() : *map.findSymbol(planted.symbol);
        out.seeds.push_back(seed);
        out.ids.push_back(id);
    });
    out.ids.insert(out.ids.end(), frozenIds.begin(), frozenIds.end());
    return out;
}

constexpr float kDensest = 1e9f;  // leaves a square metre: as good as no cap

GrowthLimits growthLimits(const EspGrowDef& def) {
    static_assert(uint32_t(WalkMode::paper) == ESP_WALK_PAPER && uint32_t(TangentMode::paper) == ESP_TANGENT_PAPER);
    GrowthLimits limits;
    limits.walk = WalkMode(def.walk);
    limits.tangents = TangentMode(def.tangents);
    limits.maxNodes = def.maxNodes;
    limits.maxDepth = def.maxDepth;
    limits.leafDensityCap = def.leafDensityCap < kDensest ? def.leafDensityCap : 0;
    return limits;
}

// All is as it has grown.
void noteGrown(EspContext& context, std::vector<uint32_t> grammars, std::vector<uint32_t> seeds) {
    context.grownGrammars = std::move(grammars);
    context.grownSeeds = std::move(seeds);
    context.changes = {.everything = false, .cells = {}, .uses = {}, .grammars = {}};
    context.surfaceChanges.clear();
    noteSurfaces(context);
    context.dropTriangles();
    context.nodes.plants.made();
}

EspResult growPlants(EspContext& context) {
    Status tables = context.refreshTables();
    if (!tables) return failGpu(&context, tables.failure());
    noteSurfaceChanges(context);
    Status variants = refreshVariants(context);
    if (!variants) return failGpu(&context, variants.failure());
    Maps maps = mapsOf(context);
    Planting planting = plantingOf(context, maps);
    // Indices of grammars stay what they were only as long as none goes.
    const std::vector<uint32_t>& known = context.grownGrammars;
    if (known.size() > maps.ids.size() || !std::equal(known.begin(), known.end(), maps.ids.begin()))
        context.changes.everything = true;

    GrowthInputs inputs;
    inputs.surfaces = addressOf<SurfaceBuf>(context.surfaceTable);
    inputs.surfaceCount = std::max(context.surfaceSlots(), 1u);
    inputs.layers = addressOf<LayerBuf>(context.layerTable);
    inputs.grammars = maps.refs;
    inputs.widths = maps.widths;
    inputs.avoid = maps.avoid;
    inputs.seeds = planting.seeds;
    inputs.frozen = planting.frozen;
    inputs.pruned = context.pruned;
    inputs.limits = growthLimits(context.grow);
    inputs.native = !context.grow.shadersOnly;
    inputs.changes = &context.changes;
    inputs.watch = context.watch.get();
    Status grown = context.growth->grow(inputs);
    if (!grown && inputs.watch && inputs.watch->stopped()) return fail(&context, ESP_STOPPED, grown.failure().text());
    if (!grown) return failWork(&context, grown.failure());
    noteGrown(context, std::move(maps.ids), std::move(planting.ids));
    return ESP_OK;
}

EspResult updatePlants(EspContext& context) {
    const graph::Node& plants = context.nodes.plants;
    if (!plants.due()) return ESP_OK;
    if (!context.device->lost() && context.failed.known(plants.version())) return context.failed.tell(context.error);
    const EspResult grown = grownOr(context, [&] { return growPlants(context); });
    return grown == ESP_OK ? context.failed.forget() : context.failed.note(plants.version(), grown, context.error);
}

}  // namespace

void setDefaults(EspGrowDef& def) {
    const GrowthLimits limits;
    def.maxNodes = limits.maxNodes;
    def.maxDepth = limits.maxDepth;
    def.leafDensityCap = limits.leafDensityCap;
}

}  // namespace espalier

using namespace espalier;

extern "C" {

EspResult espDefaultGrowDef(EspGrowDef* out) {
    return giveDefaults("espDefaultGrowDef", out);
}

EspResult espSetGrow(EspContext* context, const EspGrowDef* given) {
    return guarded(context, [&] {
        const EspGrowDef def = taken("espSetGrow", given);
        if (!isAmong(def.walk, ESP_WALK_INTRINSIC, ESP_WALK_PAPER) ||
            !isAmong(def.tangents, ESP_TANGENT_STEM, ESP_TANGENT_PAPER) || def.maxNodes < 1 || def.maxDepth < 1 ||
            def.maxDepth > 65534 || !std::isfinite(def.leafDensityCap) || def.leafDensityCap < 0)
            return fail(context, ESP_INVALID_ARGUMENT, "espSetGrow: a value is out of its range");
        const EspGrowDef& now = context->grow;
        if (now.walk == def.walk && now.tangents == def.tangents && now.maxNodes == def.maxNodes &&
            now.maxDepth == def.maxDepth && now.leafDensityCap == def.leafDensityCap &&
            now.shadersOnly == def.shadersOnly)
            return ESP_OK;
        context->grow = def;
        context->changeWholly(context->nodes.limits);
        return ESP_OK;
    });
}

EspResult espWatchGrowth(EspContext* context, EspGrowingFn growing, void* user) {
    return guarded(context, [&] {
        context->watch.reset();
        if (growing)
            context->watch = std::make_unique<GrowthWatch>([=](uint64_t nodes) { return growing(user, nodes) != 0; });
        return ESP_OK;
    });
}

EspResult espUpdate(EspContext* context) {
    return guarded(context, [&] {
        context->device->hostSubmitted();  // as espalier.h asks for; a host that draws no more tells no more of frames
        context->renderer->unprepare();
        if (context->streaming) context->streaming->advance();
        if (context->loads) context->loads->advance();
        EspResult first = ESP_OK;
        std::string why;
        const auto note = [&](EspResult result) {
            if (first == ESP_OK && result != ESP_OK) why = context->error;
            if (first == ESP_OK) first = result;
            return result == ESP_OK;
        };
        if (Status kept = keepBehind(*context); !kept) note(failGpu(context, kept.failure()));
        note(updateGraphs(*context));  // they ask for surfaces and plants
        note(updateTown(*context));
        if (note(updatePlants(*context))) note(updatePatterns(*context));
        context->error = why;
        return first;
    });
}

}  // extern "C"
