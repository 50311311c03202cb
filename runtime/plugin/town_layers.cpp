// Layers of a town: which of them its roofs read, what houses have to grow anew for them, and reading them back.
#include <algorithm>

#include "runtime/plugin/context.hpp"
#include "runtime/plugin/errors.hpp"
#include "runtime/plugin/painting.hpp"
#include "runtime/plugin/shown_layers.hpp"
#include "runtime/plugin/town_growth.hpp"

namespace espalier {
namespace {

constexpr float kHouseReach = 1.5f;  // metres that roofs go beyond their walls

// Whether a layer holds something else within the rectangle than when the roofs grew over it. before: null where it
// wasn't there, and `fill` was read.
bool differs(const PlanLayer& layer, const std::vector<float>* before, float fill, const PlanRect& r, uint32_t side) {
    for (uint32_t y = r.y0; y < r.y1; ++y)
        for (size_t i = size_t(y) * side + r.x0; i < size_t(y) * side + r.x1; ++i)
            if (layer.texels[i] != (before ? (*before)[i] : fill)) return true;
    return false;
}

}  // namespace

void LoadedTown::stands(Version version, bool wholly) {
    const uint32_t side = layers.site().size;
    const auto note = [&](const PlanLayer& layer, const PlanRect& r) {
        std::vector<float>& texels = grownOver[layer.name];
        if (texels.size() != layer.texels.size()) {
            texels = layer.texels;
            return;
        }
        for (uint32_t y = r.y0; y < r.y1; ++y)
            std::copy_n(&layer.texels[size_t(y) * side + r.x0], r.x1 - r.x0, &texels[size_t(y) * side + r.x0]);
    };
    std::erase_if(grownOver, [&](const auto& entry) { return !layers.find(entry.first); });
    for (const auto& [layerName, rect] : painted)
        if (const PlanLayer* layer = layers.find(layerName); layer && !wholly && !rect.empty()) note(*layer, rect);
    if (wholly)
        for (const PlanLayer& layer : layers.all()) note(layer, layers.whole());
    grown = version;
    changed.clear();
    painted.clear();
}

const LoadedGrammar* townGrammar(const EspContext& context) {
    return context.town ? context.grammars.find(context.town->grammar) : nullptr;
}

float fillOverTown(const EspContext& context, const std::string& name) {
    const LoadedGrammar* grammar = townGrammar(context);
    const auto index = grammar ? grammar->map.findContext(name) : std::nullopt;
    return index ? grammar->map.contexts()[*index].fill : declaredFill(context, name).value_or(0);
}

void bindTownLayers(EspContext& context, RoofInputs& inputs) {
    LoadedTown& town = *context.town;
    const LoadedGrammar& grammar = *townGrammar(context);
    const auto& houses = town.structure.houses;
    const size_t count = std::min<size_t>(grammar.map.contexts().size(), kRoofLayers);
    const bool anew = town.growsWhole(grammar);
    inputs.site = town.layers.site();
    town.means.resize(houses.size() * kRoofLayers);
    std::vector<bool> edited(houses.size());  // other outlines have other means
    for (uint32_t h : town.changed) edited[h] = true;
    const std::span<const uint32_t> reads = anew ? std::span<const uint32_t>() : context.roofs->reads();
    for (size_t i = 0; i < count; ++i) {
        const ContextInfo& declared = grammar.map.contexts()[i];
        const PlanLayer* layer = town.layers.find(declared.name);
        const auto before = town.grownOver.find(declared.name);
        const std::vector<float>* grownOver = before == town.grownOver.end() ? nullptr : &before->second;
        PlanRect changed;
        for (const auto& [name, rect] : town.painted)
            if (name == declared.name) changed = rect;
        if (layer) inputs.layers[i].texels = layer->texels.data();
        inputs.layers[i].firstRow = anew ? 0 : changed.empty() ? 0 : changed.y0;
        inputs.layers[i].rowCount = anew ? ~0u : changed.empty() ? 0 : changed.y1 - changed.y0;
        for (uint32_t h = 0; h < houses.size(); ++h) {
            float& mean = town.means[h * kRoofLayers + i];
            const PlanRect under = town.layers.under(houses[h], kHouseReach);
            const bool painted =
                changed.meets(under) &&
                (!layer || differs(*layer, grownOver, declared.fill, under.within(changed), town.layers.site().size));
            const bool fresh = anew || edited[h] || painted;
            if (!layer)
                mean = declared.fill;
            else if (fresh)
                mean = town.layers.mean(*layer, houses[h]);
            if (fresh && !anew && h < reads.size() && (reads[h] & (0x101u << i)) != 0) town.changed.push_back(h);
        }
    }
    inputs.means = town.means;
    std::ranges::sort(town.changed);
    town.changed.erase(std::unique(town.changed.begin(), town.changed.end()), town.changed.end());
}

uint32_t shownTownLayer(const EspContext& context, const std::string& name) {
    const std::vector<ContextInfo>& contexts = context.town->contexts;
    return shownLayers(name, [&](const std::string& layer, std::span<const uint32_t>) -> std::optional<uint32_t> {
        const auto found = std::ranges::find(contexts, layer, &ContextInfo::name);
        const auto index = size_t(found - contexts.begin());
        return index < std::min<size_t>(contexts.size(), kRoofLayers) ? std::optional(uint32_t(index)) : std::nullopt;
    });
}

}  // namespace espalier

using namespace espalier;

extern "C" {

EspResult espTownInfo(const EspContext* context, EspTownInfo* out) {
    return guarded(context, [&] {
        if (!context->town) return fail(context, ESP_INVALID_ARGUMENT, "espTownInfo: there is no town");
        const RoofSite& site = context->town->layers.site();
        EspTownInfo info{};
        info.houses = uint32_t(context->town->structure.houses.size());
        info.layerLow[0] = site.low.x;
        info.layerLow[1] = site.low.y;
        info.layerSide = float(site.size) / site.perMetre;
        info.layerTexels = site.size;
        info.groundHeight = context->town->ground.height;
        info.origin[0] = context->town->origin.x;
        info.origin[1] = context->town->origin.y;
        info.geographic = context->town->geographic ? 1 : 0;
        give("espTownInfo", out, info);
        return ESP_OK;
    });
}

EspResult espReadTownLayer(EspContext* context, const char* name, float* texels, uint32_t* size) {
    return guarded(context, [&] {
        if (!name || !size || !context->town)
            return fail(context, ESP_INVALID_ARGUMENT, "espReadTownLayer: null pointer, or no town");
        const uint32_t side = context->town->layers.site().size, room = *size;
        *size = side;
        if (!texels || room == 0) return ESP_OK;
        if (room < side)
            return fail(context, ESP_INVALID_ARGUMENT,
                        "espReadTownLayer: the layer has " + std::to_string(side) +
                            " texels a side, there is room for " + std::to_string(room));
        const PlanLayer* layer = context->town->layers.find(name);
        if (layer)
            std::ranges::copy(layer->texels, texels);
        else
            std::fill_n(texels, size_t(side) * side, fillOverTown(*context, name));
        return ESP_OK;
    });
}

uint32_t espTownLayerCount(const EspContext* context) {
    return context && context->town ? uint32_t(context->town->layers.all().size()) : 0;
}
const char* espTownLayerName(const EspContext* context, uint32_t index) {
    return index < espTownLayerCount(context) ? context->town->layers.all()[index].name.c_str() : "";
}

}  // extern "C"
