// Layers and seeds: pictures laid into the walk's UV, and places with a direction that walks start from.
#include <cmath>
#include <cstring>

#include "runtime/plugin/context.hpp"
#include "runtime/plugin/layer_resample.hpp"
#include "shaders/shared/random.h"

namespace espalier {
namespace {

constexpr uint32_t kMaxLayerSide = 8192;
constexpr uint32_t kMaxSeeds = 1u << 20;

EspResult setLayer(EspContext& context, const EspLayerDef& def) {
    const PlacedSurface* surface = context.surfaces.find(def.surface.id);
    if (!surface) return fail(&context, ESP_INVALID_ARGUMENT, "espSetLayer: no such surface");
    if (!def.name || !*def.name) return fail(&context, ESP_INVALID_ARGUMENT, "espSetLayer: a layer needs a name");
    if (def.space != ESP_LAYER_WALK_UV && def.space != ESP_LAYER_MATERIAL_UV)
        return fail(&context, ESP_INVALID_ARGUMENT, "espSetLayer: no such UV set");
    const auto isIt = [&](const PaintedLayer& layer) {
        return layer.surface == def.surface.id && layer.name == def.name;
    };
    if (!def.texels) {
        if (std::erase_if(context.layers, isIt) == 0) return ESP_OK;
    } else {
        if (def.width < 1 || def.height < 1 || def.width > kMaxLayerSide || def.height > kMaxLayerSide)
            return fail(&context, ESP_INVALID_ARGUMENT,
                        std::string("espSetLayer: ") + def.name + ": " + std::to_string(def.width) + " x " +
                            std::to_string(def.height) + " texels; 1 to 8192 a side are allowed");
        const LayerPicture picture{
            {def.texels, size_t(def.width) * def.height}, def.width, def.height, def.space == ESP_LAYER_MATERIAL_UV};
        PaintedLayer layer{def.name, def.surface.id, surface->data.levels.front().size, {}};
        Result<Buffer> texels = makeBuffer(*context.device, "layer", resampleLayer(surface->data, picture));
        if (!texels) return failGpu(&context, texels.failure());
        layer.texels = std::move(*texels);
        std::erase_if(context.layers, isIt);
        context.layers.push_back(std::move(layer));
    }
    context.tablesStale = true;
    wholeLayerChanged(context, def.surface.id, def.name);
    return ESP_OK;
}

// The unit tangent nearest to `wanted` on a plane; any where there is none.
glm::vec3 laidInto(glm::vec3 wanted, glm::vec3 normal) {
    const auto tangent = [&](glm::vec3 v) { return v - normal * glm::dot(v, normal); };
    const float length = glm::length(wanted);
    glm::vec3 best = length > 0 ? tangent(wanted / length) : glm::vec3(0);
    if (!(glm::length(best) > 1e-3f)) best = tangent({0, 1, 0});
    if (!(glm::length(best) > 1e-3f)) best = tangent({1, 0, 0});
    if (!(glm::length(best) > 1e-3f)) best = tangent({0, 0, 1});
    return glm::normalize(best);
}

EspResult plant(EspContext& context, const EspSeedDef& def, EspSeed* out) {
    const LoadedGrammar* grammar = context.grammars.find(def.grammar.id);
    if (!grammar) return fail(&context, ESP_INVALID_ARGUMENT, "espPlant: no such grammar");
    for (float v :
         {def.position[0], def.position[1], def.position[2], def.direction[0], def.direction[1], def.direction[2]})
        if (!std::isfinite(v))
            return fail(&context, ESP_INVALID_ARGUMENT, "espPlant: position or direction not finite");
    if (context.seeds.size() >= kMaxSeeds)
        return fail(&context, ESP_INVALID_ARGUMENT, "espPlant: there are 1048576 seeds already");
    if (def.symbol && *def.symbol) {
        const auto symbol = grammar->map.findSymbol(def.symbol);
        if (!symbol || !grammar->map.symbols()[*symbol].grows)
            return fail(&context, ESP_INVALID_ARGUMENT,
                        grammar->name + ": no rule grows from '" + std::string(def.symbol) + "'");
    }
    const auto point = nearestOnSurfaces(context, {def.position[0], def.position[1], def.position[2]});
    if (!point) return fail(&context, ESP_INVALID_ARGUMENT, "espPlant: there is no surface to plant on");

    const PlacedSurface& surface = *context.surfaces.find(point->surface);
    PlantedSeed seed;
    seed.grammar = def.grammar.id;
    seed.surface = point->surface;
    seed.symbol = def.symbol ? def.symbol : "";
    seed.number = def.number;
    uint32_t& uses = context.numberUses[def.number];
    seed.ordinal = uses;
    seed.walk.place = (surface.instance << 16) | point->chart;
    seed.walk.uv = point->uv;
    const glm::vec3 world = laidInto({def.direction[0], def.direction[1], def.direction[2]}, point->normal);
    seed.walk.direction = glm::normalize(glm::mat3(surface.toObject) * world);
    const uint32_t id = context.seeds.insert(std::move(seed));
    if (!id) return fail(&context, ESP_OUT_OF_MEMORY, "espPlant: no ids left");
    ++uses;
    ++context.revision;
    out->id = id;
    return ESP_OK;
}

}  // namespace
}  // namespace espalier

using namespace espalier;

extern "C" {

EspLayerDef espDefaultLayerDef(void) {
    EspLayerDef def{};
    def.space = ESP_LAYER_MATERIAL_UV;
    return def;
}

EspResult espSetLayer(EspContext* context, const EspLayerDef* def) {
    return guarded(context, [&] {
        if (!def) return fail(context, ESP_INVALID_ARGUMENT, "espSetLayer: null pointer");
        return setLayer(*context, *def);
    });
}

EspSeedDef espDefaultSeedDef(void) {
    EspSeedDef def{};
    def.number = 1;
    return def;
}

EspResult espPlant(EspContext* context, const EspSeedDef* def, EspSeed* out) {
    return guarded(context, [&] {
        if (!def || !out) return fail(context, ESP_INVALID_ARGUMENT, "espPlant: null pointer");
        return plant(*context, *def, out);
    });
}

EspResult espRemoveSeed(EspContext* context, EspSeed seed) {
    return guarded(context, [&] {
        if (!context->seeds.erase(seed.id)) return fail(context, ESP_INVALID_ARGUMENT, "espRemoveSeed: no such seed");
        ++context->revision;
        return ESP_OK;
    });
}

EspResult espRemoveAllSeeds(EspContext* context) {
    return guarded(context, [&] {
        if (context->seeds.size() == 0) return ESP_OK;
        std::vector<uint32_t> all;
        context->seeds.forEach([&](uint32_t id, const PlantedSeed&) { all.push_back(id); });
        for (uint32_t id : all) context->seeds.erase(id);
        context->numberUses.clear();
        ++context->revision;
        return ESP_OK;
    });
}

}  // extern "C"
