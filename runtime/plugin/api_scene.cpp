// Layers: pictures laid into the walk's UV.
#include <algorithm>

#include "runtime/core/undo.hpp"
#include "runtime/plugin/context.hpp"
#include "runtime/plugin/errors.hpp"
#include "runtime/plugin/given.hpp"
#include "runtime/plugin/layer_resample.hpp"
#include "runtime/plugin/painting.hpp"

namespace espalier {
namespace {

// The baker puts all vertices of a model without UVs at one place.
bool hasMaterialUv(const SurfaceData& surface) {
    return std::ranges::any_of(surface.vertices, [&](const DrawVertex& v) { return v.uv != surface.vertices[0].uv; });
}

// The layer's texels in texelIndex order.
std::vector<float> laidOut(const EspContext& context, const SurfaceData& surface, const EspLayerDef& def) {
    if (def.space == ESP_LAYER_MATERIAL_UV && !hasMaterialUv(surface))
        context.log(Severity::warning, std::string("layer '") + def.name + "': " + surface.source +
                                           " has no UVs for a picture to be drawn in: one texel of it is everywhere");
    if (def.space != ESP_LAYER_TEXELS)
        return resampleLayer(
            surface,
            {{def.texels, size_t(def.width) * def.height}, def.width, def.height, def.space == ESP_LAYER_MATERIAL_UV});
    std::vector<float> texels(size_t(def.width) * def.height);
    for (uint32_t y = 0; y < def.height; ++y)
        for (uint32_t x = 0; x < def.width; ++x) {
            const float value = def.texels[size_t(y) * def.width + x];
            texels[texelIndex(def.width, x, y)] = layerValue(value);
        }
    return texels;
}

EspResult setLayer(EspContext& context, const EspLayerDef& def) {
    const auto isIt = [&](const PaintedLayer& layer) {
        return layer.surface == def.surface.id && layer.name == def.name;
    };
    // First of all, since there may be no memory for it.
    const auto tell = [&] {
        Undo untold([&] { context.changeWholly(context.nodes.paint); });
        wholeLayerChanged(context, def.surface.id, def.name);
        untold.done();
        context.nodes.layers.change();
    };
    if (def.texels) {
        const PlacedSurface& surface = *context.surfaces.find(def.surface.id);
        PaintedLayer layer;
        layer.name = def.name;
        layer.surface = def.surface.id;
        layer.size = surface.content->data.levels.front().size;
        layer.kept = laidOut(context, surface.content->data, def);
        layer.number = context.layersMade + 1;
        Result<Buffer> texels = makeBuffer(*context.device, "layer", layer.kept);
        if (!texels) return failGpu(&context, texels.failure());
        layer.texels = std::move(*texels);
        tell();
        context.layers.reserve(context.layers.size() + 1);
        std::erase_if(context.layers, isIt);
        context.layers.push_back(std::move(layer));
        context.layersMade += 1;
    } else if (std::ranges::any_of(context.layers, isIt)) {
        tell();
        std::erase_if(context.layers, isIt);
    }
    return ESP_OK;
}

EspResult checkLayer(const EspContext& context, const EspLayerDef& def) {
    const PlacedSurface* surface = context.surfaces.find(def.surface.id);
    if (!surface) return fail(&context, ESP_INVALID_ARGUMENT, "espSetLayer: no such surface");
    if (!def.name || !*def.name) return fail(&context, ESP_INVALID_ARGUMENT, "espSetLayer: a layer needs a name");
    if (!isAmong(def.space, ESP_LAYER_WALK_UV, ESP_LAYER_TEXELS))
        return fail(&context, ESP_INVALID_ARGUMENT, "espSetLayer: no such UV set");
    if (!def.texels) return ESP_OK;
    const uint32_t side = surface->content->data.levels.front().size;
    const bool exact = def.space == ESP_LAYER_TEXELS;
    if (exact ? def.width != side || def.height != side
              : def.width < 1 || def.height < 1 || def.width > kMaxLayerSide || def.height > kMaxLayerSide)
        return fail(&context, ESP_INVALID_ARGUMENT,
                    std::string("espSetLayer: ") + def.name + ": " + std::to_string(def.width) + " x " +
                        std::to_string(def.height) + " texels; " +
                        (exact ? "the surface has " + std::to_string(side) : std::string("1 to 8192")) + " a side");
    return ESP_OK;
}

EspResult importLayer(EspContext& context, const EspLayerDef& def, EspStroke* out) {
    const PlacedSurface& surface = *context.surfaces.find(def.surface.id);
    return replaceLayer(context, def.surface.id, def.name, laidOut(context, surface.content->data, def), out);
}

}  // namespace

void setDefaults(EspLayerDef& def) {
    def.space = ESP_LAYER_MATERIAL_UV;
}

}  // namespace espalier

using namespace espalier;

extern "C" {

EspResult espDefaultLayerDef(EspLayerDef* out) {
    return giveDefaults("espDefaultLayerDef", out);
}

EspResult espSetLayer(EspContext* context, const EspLayerDef* given) {
    return guarded(context, [&] {
        const EspLayerDef def = taken("espSetLayer", given);
        if (EspResult bad = checkLayer(*context, def)) return bad;
        return setLayer(*context, def);
    });
}

EspResult espImportLayer(EspContext* context, const EspLayerDef* given, EspStroke* out) {
    return guarded(context, [&] {
        const EspLayerDef def = taken("espImportLayer", given);
        if (!def.texels || !out) return fail(context, ESP_INVALID_ARGUMENT, "espImportLayer: null pointer");
        if (EspResult bad = checkLayer(*context, def)) return bad;
        return importLayer(*context, def, out);
    });
}

}  // extern "C"
