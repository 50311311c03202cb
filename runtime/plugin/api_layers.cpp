// Layers by name: the numbers by which kernels know them, what changed of them, reading them back.
#include <algorithm>
#include <bit>

#include "runtime/plugin/context.hpp"
#include "runtime/plugin/errors.hpp"
#include "runtime/plugin/painting.hpp"

namespace espalier {
namespace {

// without: id of a grammar that is of no account.
bool isRead(const EspContext& context, uint32_t number, uint32_t without) {
    bool read = false;
    const auto look = [&](const std::vector<uint32_t>& layerOf) {
        read = read || std::ranges::find(layerOf, number) != layerOf.end();
    };
    context.grammars.forEach([&](uint32_t id, const LoadedGrammar& grammar) {
        if (id != without) look(grammar.layerOf);
    });
    for (const GrammarVariant& variant : context.variants) {
        const LoadedGrammar* grammar = context.grammars.find(variant.grammar);
        const bool stands = grammar && variant.madeFrom == grammar->version;  // else it takes its grammar's next
        if (variant.used && variant.grammar != without && stands) look(variant.layerOf);
    }
    return read;
}

EspResult readLayer(EspContext& context, uint32_t surface, const char* name, float* texels, uint32_t* size) {
    const PlacedSurface* placed = context.surfaces.find(surface);
    if (!placed) return fail(&context, ESP_INVALID_ARGUMENT, "espReadLayer: no such surface");
    const uint32_t side = placed->content->data.levels.front().size, room = *size;
    *size = side;
    if (!texels || room == 0) return ESP_OK;
    if (room < side)
        return fail(&context, ESP_INVALID_ARGUMENT,
                    "espReadLayer: the layer has " + std::to_string(side) + " texels a side, there is room for " +
                        std::to_string(room));
    const PaintedLayer* layer = paintedLayer(context, surface, name);
    if (!layer) {
        std::fill_n(texels, size_t(side) * side, declaredFill(context, name).value_or(0));
        return ESP_OK;
    }
    Result<std::vector<float>> values = readVector<float>(*context.device, layer->texels, 0, size_t(side) * side);
    if (!values) return failGpu(&context, values.failure());
    for (uint32_t y = 0; y < side; ++y)
        for (uint32_t x = 0; x < side; ++x) texels[size_t(y) * side + x] = (*values)[texelIndex(side, x, y)];
    return ESP_OK;
}

// Calls tell(name) for all painted layers, each once, in the order in which they came. Takes no memory.
template <class Tell>
void forEachPaintedName(const EspContext& context, Tell&& tell) {
    for (const PaintedLayer& layer : context.layers)
        if (&*std::ranges::find(context.layers, layer.name, &PaintedLayer::name) == &layer) tell(layer.name);
}

}  // namespace

std::optional<uint32_t> sceneLayer(EspContext& context, const std::string& name, float fill,
                                   std::span<const uint32_t> kept, uint32_t without) {
    const SceneLayer wanted{name, fill};
    std::vector<SceneLayer>& layers = context.sceneLayers;
    if (const auto found = std::ranges::find(layers, wanted); found != layers.end())
        return uint32_t(found - layers.begin());
    uint32_t number = 0;
    if (layers.size() < kMaxLayers) {
        number = uint32_t(layers.size());
        layers.push_back(wanted);
    } else {
        // One that grammars have read, or a view has shown, and that nobody reads any more.
        while (number < kMaxLayers &&
               (isRead(context, number, without) || std::ranges::find(kept, number) != kept.end()))
            ++number;
        if (number == kMaxLayers) return std::nullopt;
        layers[number] = wanted;
    }
    context.nodes.layers.change();
    return number;
}

PaintedLayer* paintedLayer(EspContext& context, uint32_t surface, const std::string& name) {
    for (PaintedLayer& layer : context.layers)
        if (layer.surface == surface && layer.name == name) return &layer;
    return nullptr;
}

std::optional<float> declaredFill(const EspContext& context, const std::string& name) {
    std::optional<float> fill;
    context.grammars.forEach([&](uint32_t, const LoadedGrammar& grammar) {
        if (fill) return;
        if (const auto index = grammar.map.findContext(name)) fill = grammar.map.contexts()[*index].fill;
    });
    return fill;
}

void layerChanged(EspContext& context, uint32_t surface, const std::string& name, std::span<const uint32_t> blocks,
                  std::span<const uint64_t> texels) {
    if (blocks.empty() || !declaredFill(context, name)) return;
    const PlacedSurface& placed = *context.surfaces.find(surface);
    const uint32_t size = placed.content->data.levels.front().size, side = size / 8;
    for (uint32_t layer = 0; layer < context.sceneLayers.size(); ++layer) {
        if (context.sceneLayers[layer].name != name) continue;
        for (size_t i = 0; i < blocks.size(); ++i) {
            const uint32_t x = blocks[i] % side * 8, y = blocks[i] / side * 8;
            if (texels.empty() || texels[i] == ~uint64_t(0)) {
                context.changes.markTexels(placed.instance, layer, size, x, y, x + 8, y + 8);
                continue;
            }
            for (uint32_t row = 0; row < 8; ++row) {
                const uint8_t bits = uint8_t(texels[i] >> (8 * row));
                context.changes.markTexels(placed.instance, layer, size, x + uint32_t(std::countr_zero(bits)), y + row,
                                           x + 8 - uint32_t(std::countl_zero(bits)), y + row + 1);
            }
        }
    }
    context.nodes.paint.change();
}

void wholeLayerChanged(EspContext& context, uint32_t surface, const std::string& name) {
    if (!declaredFill(context, name)) return;
    const PlacedSurface& placed = *context.surfaces.find(surface);
    for (uint32_t layer = 0; layer < context.sceneLayers.size(); ++layer)
        if (context.sceneLayers[layer].name == name)
            context.changes.markLayer(placed.instance, layer, placed.content->data.levels.front().size);
    context.nodes.paint.change();
}

}  // namespace espalier

using namespace espalier;

extern "C" {

uint32_t espPaintedLayerCount(const EspContext* context) {
    uint32_t count = 0;
    if (context) forEachPaintedName(*context, [&](const std::string&) { ++count; });
    return count;
}

const char* espPaintedLayerName(const EspContext* context, uint32_t index) {
    const char* found = "";
    uint32_t number = 0;
    if (context)
        forEachPaintedName(*context, [&](const std::string& name) {
            if (number++ == index) found = name.c_str();
        });
    return found;
}

int espLayerPainted(const EspContext* context, EspSurface surface, const char* layer) {
    if (!context || !layer) return 0;
    return std::ranges::any_of(context->layers, [&](const PaintedLayer& painted) {
        return painted.surface == surface.id && painted.name == layer;
    });
}

EspResult espReadLayer(EspContext* context, EspSurface surface, const char* layer, float* texels, uint32_t* size) {
    return guarded(context, [&] {
        if (!layer || !size) return fail(context, ESP_INVALID_ARGUMENT, "espReadLayer: null pointer");
        return readLayer(*context, surface.id, layer, texels, size);
    });
}

}  // extern "C"
