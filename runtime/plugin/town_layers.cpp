// Layers of a town: which of them strokes reach, what houses have to grow anew for them, and their pictures.
#include <algorithm>
#include <cmath>

#include "runtime/core/undo.hpp"
#include "runtime/plugin/context.hpp"
#include "runtime/plugin/shown_layers.hpp"

namespace espalier {
namespace {

constexpr float kHouseReach = 1.5f;  // metres that roofs go beyond their walls
constexpr uint32_t kMaxSide = 8192;

const LoadedGrammar* grammarOf(const EspContext& context) {
    return context.town ? context.grammars.find(context.town->grammar) : nullptr;
}

// Where what changes of a layer is noted. May find no memory for it.
PlanRect& notesOf(LoadedTown& town, const std::string& name) {
    for (auto& [known, changed] : town.painted)
        if (known == name) return changed;
    return town.painted.emplace_back(name, PlanRect()).second;
}

// What the town's roofs read where nothing of the layer is painted.
float fillOverTown(const EspContext& context, const std::string& name) {
    const LoadedGrammar* grammar = grammarOf(context);
    const auto index = grammar ? grammar->map.findContext(name) : std::nullopt;
    return index ? grammar->map.contexts()[*index].fill : declaredFill(context, name).value_or(0);
}

// The layer that strokes reach, made if there is none and the town's grammar reads it; else null.
PlanLayer* townLayer(EspContext& context, const std::string& name) {
    if (!context.town) return nullptr;
    if (PlanLayer* known = context.town->layers.find(name)) return known;
    const LoadedGrammar* grammar = grammarOf(context);
    const auto index = grammar ? grammar->map.findContext(name) : std::nullopt;
    if (!index || *index >= kRoofLayers) return nullptr;
    return &context.town->layers.make(name, fillOverTown(context, name));
}

// Bilinear, between the centres of texels.
std::vector<float> resampled(const float* texels, uint32_t width, uint32_t height, uint32_t side) {
    std::vector<float> out(size_t(side) * side);
    const auto at = [&](uint32_t x, uint32_t y) {
        const float v = texels[size_t(y) * width + x];
        return v > 0 ? std::min(v, 1.f) : 0;  // NaN becomes 0
    };
    const auto split = [&](uint32_t i, uint32_t count, uint32_t& low, uint32_t& high) {
        const float g = std::clamp((float(i) + .5f) * float(count) / float(side) - .5f, 0.f, float(count) - 1);
        low = uint32_t(g);
        high = std::min(low + 1, count - 1);
        return g - float(low);
    };
    for (uint32_t y = 0; y < side; ++y)
        for (uint32_t x = 0; x < side; ++x) {
            uint32_t x0, x1, y0, y1;
            const float fx = split(x, width, x0, x1), fy = split(y, height, y0, y1);
            out[size_t(y) * side + x] =
                (at(x0, y0) * (1 - fx) + at(x1, y0) * fx) * (1 - fy) + (at(x0, y1) * (1 - fx) + at(x1, y1) * fx) * fy;
        }
    return out;
}

}  // namespace

bool paintTown(EspContext& context, PaintStroke& stroke, std::span<const DabRecord> dabs) {
    PlanLayer* layer = townLayer(context, stroke.layer);
    if (!layer) return false;
    LoadedTown& town = *context.town;
    if (stroke.town != town.number) stroke.plan = {};  // of a town that is gone
    stroke.town = town.number;
    BrushRecord brush = stroke.brush;
    float filled = 0;
    if (stroke.erases && !espLayerFilled(&context, stroke.layer.c_str(), &filled))
        brush.target = fillOverTown(context, stroke.layer);
    Undo untold([&] {  // some of the dabs may be painted
        town.stale = true;
        town.revision += 1;
    });
    const PlanRect rect = town.layers.dabs(*layer, brush, stroke.smooths, dabs, stroke.plan);
    if (!rect.empty()) {
        notesOf(town, stroke.layer).add(rect);
        town.revision += 1;
    }
    untold.done();
    return true;
}

bool fillTown(EspContext& context, PaintStroke& stroke, float value) {
    PlanLayer* layer = townLayer(context, stroke.layer);
    if (!layer) return false;
    LoadedTown& town = *context.town;
    stroke.town = town.number;
    notesOf(town, stroke.layer).add(town.layers.fill(*layer, value, stroke.plan));
    town.revision += 1;
    return true;
}

void closeTown(EspContext& context, PaintStroke& stroke) {
    const bool ours = context.town && context.town->number == stroke.town;
    if (const PlanLayer* layer = ours ? context.town->layers.find(stroke.layer) : nullptr)
        context.town->layers.close(*layer, stroke.plan);
}

void swapTown(EspContext& context, PaintStroke& stroke) {
    const bool ours = context.town && context.town->number == stroke.town && !stroke.plan.blocks.empty();
    PlanLayer* layer = ours ? context.town->layers.find(stroke.layer) : nullptr;
    if (!layer) return;
    PlanRect& changed = notesOf(*context.town, stroke.layer);  // there already where a call is taken back
    changed.add(context.town->layers.swap(*layer, stroke.plan));
    context.town->revision += 1;
}

void bindTownLayers(EspContext& context, RoofInputs& inputs) {
    LoadedTown& town = *context.town;
    const LoadedGrammar& grammar = *grammarOf(context);
    const auto& houses = town.structure.houses;
    const size_t count = std::min<size_t>(grammar.map.contexts().size(), kRoofLayers);
    const bool anew = town.stale || town.grammarRevision != grammar.revision;
    inputs.site = town.layers.site();
    town.means.resize(houses.size() * kRoofLayers);
    std::vector<bool> edited(houses.size());  // other outlines have other means
    for (uint32_t h : town.changed) edited[h] = true;
    const std::span<const uint32_t> reads = anew ? std::span<const uint32_t>() : context.roofs->reads();
    for (size_t i = 0; i < count; ++i) {
        const ContextInfo& declared = grammar.map.contexts()[i];
        const PlanLayer* layer = town.layers.find(declared.name);
        PlanRect changed;
        for (const auto& [name, rect] : town.painted)
            if (name == declared.name) changed = rect;
        if (layer) inputs.layers[i].texels = layer->texels.data();
        inputs.layers[i].firstRow = anew ? 0 : changed.empty() ? 0 : changed.y0;
        inputs.layers[i].rowCount = anew ? ~0u : changed.empty() ? 0 : changed.y1 - changed.y0;
        for (uint32_t h = 0; h < houses.size(); ++h) {
            float& mean = town.means[h * kRoofLayers + i];
            if (!layer) {
                mean = declared.fill;
            } else if (anew || edited[h] || changed.meets(town.layers.under(houses[h], kHouseReach))) {
                mean = town.layers.mean(*layer, houses[h]);
                if (!anew && h < reads.size() && (reads[h] & (0x101u << i)) != 0) town.changed.push_back(h);
            }
        }
    }
    inputs.means = town.means;
    std::ranges::sort(town.changed);
    town.changed.erase(std::unique(town.changed.begin(), town.changed.end()), town.changed.end());
}

uint32_t shownTownLayer(const EspContext& context, const std::string& name) {
    const LoadedGrammar* grammar = grammarOf(context);
    return shownLayers(name, [&](const std::string& layer, std::span<const uint32_t>) -> std::optional<uint32_t> {
        const auto index = grammar ? grammar->map.findContext(layer) : std::nullopt;
        return index && *index < kRoofLayers ? std::optional(uint32_t(*index)) : std::nullopt;
    });
}

}  // namespace espalier

using namespace espalier;

extern "C" {

EspResult espTownInfo(const EspContext* context, EspTownInfo* out) {
    return guarded(context, [&] {
        if (!out || !context->town) return fail(context, ESP_INVALID_ARGUMENT, "espTownInfo: null, or no town");
        const RoofSite& site = context->town->layers.site();
        *out = EspTownInfo{};
        out->houses = uint32_t(context->town->structure.houses.size());
        out->layerLow[0] = site.low.x;
        out->layerLow[1] = site.low.y;
        out->layerSide = float(site.size) / site.perMetre;
        out->layerTexels = site.size;
        out->groundHeight = context->town->ground.height;
        return ESP_OK;
    });
}

EspResult espSetTownLayer(EspContext* context, const char* name, const float* texels, uint32_t width, uint32_t height,
                          EspStroke* out) {
    return guarded(context, [&] {
        if (!name || !*name || !texels || width < 1 || height < 1 || width > kMaxSide || height > kMaxSide)
            return fail(context, ESP_INVALID_ARGUMENT, "espSetTownLayer: null, or not 1 to 8192 texels a side");
        if (!context->town) return fail(context, ESP_INVALID_ARGUMENT, "espSetTownLayer: there is no town");
        LoadedTown& town = *context->town;
        PaintStroke stroke;
        stroke.layer = name;
        stroke.town = town.number;
        stroke.open = false;
        // All that asks for memory comes before the layer changes.
        const std::vector<float> values = resampled(texels, width, height, town.layers.site().size);
        PlanRect& changed = notesOf(town, name);
        const uint32_t id = out ? context->strokes.insert({}) : 0;
        if (out && !id) return fail(context, ESP_OUT_OF_MEMORY, "espSetTownLayer: no ids left");
        Undo keeping([&] { context->strokes.erase(id); });
        const bool isNew = !town.layers.find(name);
        PlanLayer& layer = town.layers.make(name, fillOverTown(*context, name));
        Undo making([&] {
            if (isNew) town.layers.dropLast();
        });
        changed.add(town.layers.replace(layer, values, stroke.plan));
        town.revision += 1;
        making.done();
        keeping.done();
        if (!out) return ESP_OK;
        *context->strokes.find(id) = std::move(stroke);
        out->id = id;
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
