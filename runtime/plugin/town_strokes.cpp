// What strokes, fills and imports do to the layers of a town, and what of it is undone.
#include <algorithm>
#include <cmath>

#include "runtime/core/undo.hpp"
#include "runtime/plugin/errors.hpp"
#include "runtime/plugin/layer_resample.hpp"
#include "runtime/plugin/strokes.hpp"
#include "runtime/plugin/town_growth.hpp"

namespace espalier {
namespace {

// Where what changes of a layer is noted. May find no memory for it.
PlanRect& notesOf(LoadedTown& town, const std::string& name) {
    for (auto& [known, changed] : town.painted)
        if (known == name) return changed;
    return town.painted.emplace_back(name, PlanRect()).second;
}

// The layer that the stroke has painted; null if it is gone, though there may be another of its name.
PlanLayer* layerOf(EspContext& context, const PaintStroke& stroke) {
    const bool ours = context.town && context.town->number == stroke.plan.town;
    PlanLayer* layer = ours ? context.town->layers.find(stroke.layer) : nullptr;
    return layer && layer->number == stroke.plan.layer ? layer : nullptr;
}

// The town's layer of the stroke's name, made if there is none; the stroke is one of its own from here on.
PlanLayer& reach(EspContext& context, PaintStroke& stroke) {
    LoadedTown& town = *context.town;
    if (!layerOf(context, stroke)) stroke.plan = {};  // nothing yet, or on a layer that is gone
    PlanLayer* layer = town.layers.find(stroke.layer);
    if (!layer) {
        const float fill = fillOverTown(context, stroke.layer);
        layer = &town.layers.make(stroke.layer, fill, context.layersMade + 1);
        ++context.layersMade;
        stroke.plan.made = true;
        stroke.plan.fill = fill;
    }
    stroke.plan.town = town.number;
    stroke.plan.layer = layer->number;
    countStroke(layer, stroke.plan, true);
    return *layer;
}

// Bilinear, between the centres of texels.
std::vector<float> resampled(const float* texels, uint32_t width, uint32_t height, uint32_t side) {
    std::vector<float> out(size_t(side) * side);
    const auto at = [&](uint32_t x, uint32_t y) {
        const float v = texels[size_t(y) * width + x];
        return layerValue(v);
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

EspResult setLayer(EspContext& context, const std::string& name, std::span<const float> values, EspStroke* out) {
    LoadedTown& town = *context.town;
    PlanRect& changed = notesOf(town, name);
    PaintStroke stroke;
    stroke.layer = name;
    stroke.open = false;
    Undo set([&] {
        swapTown(context, stroke);
        withdraw(context, stroke);
    });
    PlanLayer& layer = reach(context, stroke);
    changed.add(town.layers.replace(layer, values, stroke.plan.record));
    context.nodes.town.change();
    closeTown(context, stroke);
    const uint32_t id = out ? context.strokes.insert({}) : 0;
    if (out && !id) return fail(&context, ESP_OUT_OF_MEMORY, "espSetTownLayer: no ids left");
    set.done();
    if (!out) return ESP_OK;
    *context.strokes.find(id) = std::move(stroke);
    out->id = id;
    return ESP_OK;
}

}  // namespace

bool townTakes(const EspContext& context, const std::string& name) {
    if (!context.town) return false;
    const LoadedGrammar* grammar = townGrammar(context);
    const auto index = grammar ? grammar->map.findContext(name) : std::nullopt;
    return (index && *index < kRoofLayers) || context.town->layers.find(name);
}

void paintTown(EspContext& context, PaintStroke& stroke, std::span<const DabRecord> dabs) {
    if (!townTakes(context, stroke.layer)) return;
    LoadedTown& town = *context.town;
    BrushRecord brush = stroke.brush;
    if (!town.layers.meets(brush, dabs)) return;
    PlanLayer& layer = reach(context, stroke);
    float filled = 0;
    if (stroke.erases && !espLayerFilled(&context, stroke.layer.c_str(), &filled))
        brush.target = fillOverTown(context, stroke.layer);
    Undo untold([&] {  // some of the dabs may be painted
        town.whole = context.nodes.town.change();
    });
    const PlanRect rect = town.layers.dabs(layer, brush, stroke.smooths, dabs, stroke.plan.record);
    if (!rect.empty()) {
        notesOf(town, stroke.layer).add(rect);
        context.nodes.town.change();
    }
    untold.done();
}

bool fillTown(EspContext& context, PaintStroke& stroke, float value) {
    if (!townTakes(context, stroke.layer)) return false;
    LoadedTown& town = *context.town;
    PlanLayer& layer = reach(context, stroke);
    notesOf(town, stroke.layer).add(town.layers.fill(layer, value, stroke.plan.record));
    context.nodes.town.change();
    return true;
}

void closeTown(EspContext& context, PaintStroke& stroke) {
    PlanLayer* layer = layerOf(context, stroke);
    if (!layer) return;
    context.town->layers.close(*layer, stroke.plan.record);
    if (!stroke.plan.record.blocks.empty() || stroke.plan.made) return;
    countStroke(layer, stroke.plan, false);
    stroke.plan = {};
}

void swapTown(EspContext& context, PaintStroke& stroke) {
    PlanLayer* layer = layerOf(context, stroke);
    // Its grammar may want another value where nothing is painted than when the layer was made.
    const bool other = layer && stroke.plan.made && stroke.plan.fill != fillOverTown(context, stroke.layer);
    if (!layer || (stroke.plan.record.blocks.empty() && !other)) return;
    LoadedTown& town = *context.town;
    PlanRect& changed = notesOf(town, stroke.layer);  // there already where a call is taken back
    changed.add(town.layers.swap(*layer, stroke.plan.record));
    if (other) changed.add(town.layers.whole());
    context.nodes.town.change();
}

void makeTownAgain(EspContext& context, const PaintStroke& stroke) {
    const PaintStroke::TownPart& plan = stroke.plan;
    const bool ours = context.town && context.town->number == plan.town;
    if (ours && plan.undone && plan.made && !context.town->layers.find(stroke.layer))
        context.town->layers.make(stroke.layer, plan.fill, plan.layer);
}

void turnTown(EspContext& context, PaintStroke& stroke) noexcept {
    turnStroke(layerOf(context, stroke), stroke.plan);
}

void dropTownMade(EspContext& context, const PaintStroke& stroke) noexcept {
    const PlanLayer* layer = layerOf(context, stroke);
    if (layer && stroke.plan.undone && stroke.plan.made && layer->strokes == 0) context.town->layers.drop(stroke.layer);
}

}  // namespace espalier

using namespace espalier;

extern "C" {

EspResult espSetTownLayer(EspContext* context, const char* name, const float* texels, uint32_t width, uint32_t height,
                          EspStroke* out) {
    return guarded(context, [&] {
        if (!name || !*name || !texels || width < 1 || height < 1 || width > kMaxLayerSide || height > kMaxLayerSide)
            return fail(context, ESP_INVALID_ARGUMENT, "espSetTownLayer: null, or not 1 to 8192 texels a side");
        if (!context->town) return fail(context, ESP_INVALID_ARGUMENT, "espSetTownLayer: there is no town");
        const uint32_t side = context->town->layers.site().size;
        return setLayer(*context, name, resampled(texels, width, height, side), out);
    });
}

}  // extern "C"
