// Growing what has changed: seeds, grammars, layers and surfaces of a context become the inputs of growth.
#include <algorithm>
#include <cmath>

#include "runtime/plugin/context.hpp"

namespace espalier {
namespace {

// After contacts were found anew: seeds whose plants may stand on what has moved.
void noteMoved(EspContext& context) {
    if (context.moved.empty()) return;
    addReached(context, context.moved);
    context.seeds.forEach([&](uint32_t, const PlantedSeed& seed) {
        if (context.moved[instanceOf(seed.surface)]) context.changes.seeds.push_back(seedKey(seed));
    });
}

// What has grown stands on these.
void noteSurfaces(EspContext& context) {
    context.grownSurfaces.assign(context.surfaceSlots(), {});
    context.surfaces.forEach([&](uint32_t id, const PlacedSurface& surface) {
        context.grownSurfaces[surface.instance] = {id, surface.toWorld};
    });
}

EspResult growPlants(EspContext& context) {
    Status tables = context.refreshTables();
    if (!tables) return failGpu(&context, tables.failure());
    noteMoved(context);
    Status variants = refreshVariants(context);
    if (!variants) return failGpu(&context, variants.failure());

    std::vector<RuleMapRef> maps;
    std::vector<float> widths;
    std::vector<std::pair<uint32_t, uint32_t>> places;  // grammar id -> index in maps
    const auto addMap = [&](const RuleMap& map, const Buffer& words, const std::vector<uint32_t>& layerOf) {
        RuleMapRef ref = map.refAt(words.address());
        if (map.roofs()) {  // keeps its number, but growth has nothing to do with it
            ref = RuleMapRef{};
            ref.features = kFeatureKnown;
        }
        for (size_t i = 0; i < layerOf.size() && i < kMaxLayers; ++i) ref.layerOf[i] = layerOf[i];
        maps.push_back(ref);
        widths.push_back(map.width());
    };
    context.grammars.forEach([&](uint32_t id, const LoadedGrammar& grammar) {
        places.push_back({id, uint32_t(maps.size())});
        addMap(grammar.map, grammar.words, grammar.layerOf);
    });
    const uint32_t firstVariant = uint32_t(maps.size());
    for (const GrammarVariant& variant : context.variants) addMap(variant.map, variant.words, variant.layerOf);
    std::vector<Seed> seeds;
    std::vector<FrozenPlant> frozen;
    std::vector<uint32_t> seedIds, frozenIds;
    context.seeds.forEach([&](uint32_t seedId, const PlantedSeed& planted) {
        Seed seed{};
        seed.key = seedKey(planted);
        if (planted.frozen) {
            frozen.push_back({seed.key, planted.frozen});
            frozenIds.push_back(seedId);
            return;
        }
        if (planted.onBare || buriedByOthers(context, planted)) return;
        seed.walk = planted.walk;
        for (const auto& [id, index] : places)
            if (id == planted.grammar) seed.grammar = index;
        if (planted.variant != kNoIndex) seed.grammar = firstVariant + planted.variant;
        const RuleMap& map = context.grammars.find(planted.grammar)->map;
        seed.symbol = planted.symbol.empty() ? map.startSymbol() : *map.findSymbol(planted.symbol);
        seeds.push_back(seed);
        seedIds.push_back(seedId);
    });

    GrowthInputs inputs;
    inputs.surfaces = addressOf<SurfaceBuf>(context.surfaceTable);
    inputs.surfaceCount = std::max(context.surfaceSlots(), 1u);
    uint32_t placedSurfaces = 0;
    context.surfaces.forEach([&](uint32_t, const PlacedSurface& surface) {
        placedSurfaces += 1;
        inputs.surfaceData = placedSurfaces == 1 ? &surface.gpu.data() : nullptr;
    });
    inputs.layers = addressOf<LayerBuf>(context.layerTable);
    inputs.grammars = maps;
    inputs.widths = widths;
    inputs.seeds = seeds;
    inputs.pruned = context.pruned;
    inputs.frozen = frozen;
    seedIds.insert(seedIds.end(), frozenIds.begin(), frozenIds.end());
    static_assert(uint32_t(WalkMode::paper) == ESP_WALK_PAPER && uint32_t(TangentMode::paper) == ESP_TANGENT_PAPER);
    inputs.limits.walk = WalkMode(context.grow.walk);
    inputs.limits.tangents = TangentMode(context.grow.tangents);
    inputs.limits.maxNodes = context.grow.maxNodes;
    inputs.limits.maxDepth = context.grow.maxDepth;
    inputs.limits.leafDensityCap = context.grow.leafDensityCap;
    inputs.native = !context.grow.shadersOnly;
    std::vector<uint32_t> ids;
    for (const auto& [id, index] : places) ids.push_back(id);
    for (uint32_t i = 0; i < context.variants.size(); ++i) ids.push_back(i);  // no grammar's id is so small
    // Indices of grammars stay what they were only as long as none goes.
    const std::vector<uint32_t>& known = context.grownGrammars;
    if (known.size() > ids.size() || !std::equal(known.begin(), known.end(), ids.begin()))
        context.changes.everything = true;
    inputs.changes = &context.changes;
    inputs.watch = context.watch.get();
    Status grown = context.growth->grow(inputs);
    if (!grown && inputs.watch && inputs.watch->stopped()) return fail(&context, ESP_STOPPED, grown.failure().text());
    if (!grown) return failWork(&context, grown.failure());
    context.grownRevision = context.revision;
    context.grownGrammars = std::move(ids);
    context.grownSeeds = std::move(seedIds);
    context.changes = {.everything = false, .cells = {}, .uses = {}, .grammars = {}};
    context.moved.clear();
    noteSurfaces(context);
    context.dropTriangles();
    return ESP_OK;
}

EspResult updatePlants(EspContext& context) {
    if (context.grownRevision == context.revision) return ESP_OK;
    if (!context.device->lost() && context.failed.known({context.revision, 0}))
        return context.failed.tell(context.error);
    const EspResult grown =
        grownOr(context, [&] { return growPlants(context); });  // contacts that it finds may raise the revision
    return grown == ESP_OK ? context.failed.forget() : context.failed.note({context.revision, 0}, grown, context.error);
}

}  // namespace
}  // namespace espalier

using namespace espalier;

extern "C" {

EspGrowDef espDefaultGrowDef(void) {
    const GrowthLimits limits;
    EspGrowDef def{};
    def.maxNodes = limits.maxNodes;
    def.maxDepth = limits.maxDepth;
    def.leafDensityCap = limits.leafDensityCap;
    return def;
}

EspResult espSetGrow(EspContext* context, const EspGrowDef* def) {
    return guarded(context, [&] {
        if (!def || !isAmong(def->walk, ESP_WALK_INTRINSIC, ESP_WALK_PAPER) ||
            !isAmong(def->tangents, ESP_TANGENT_STEM, ESP_TANGENT_PAPER) || def->maxNodes < 1 || def->maxDepth < 1 ||
            def->maxDepth > 65534 || !std::isfinite(def->leafDensityCap) || def->leafDensityCap < 0)
            return fail(context, ESP_INVALID_ARGUMENT, "espSetGrow: null pointer, or a value out of its range");
        const EspGrowDef& now = context->grow;
        if (now.walk == def->walk && now.tangents == def->tangents && now.maxNodes == def->maxNodes &&
            now.maxDepth == def->maxDepth && now.leafDensityCap == def->leafDensityCap &&
            now.shadersOnly == def->shadersOnly)
            return ESP_OK;
        context->grow = *def;
        context->touch();
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
        const EspResult town = updateTown(*context);
        const std::string why = context->error;
        const EspResult plants = updatePlants(*context);
        if (town == ESP_OK) return plants;
        context->error = why;
        return town;
    });
}

}  // extern "C"
