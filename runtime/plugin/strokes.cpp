// Enters: what a brush reaches, strokes that have ended. Leaves: the layers that they need, what the painter is to do,
// what growth has to hear of it.
#include "runtime/plugin/strokes.hpp"

#include <algorithm>

#include "runtime/core/undo.hpp"
#include "runtime/plugin/errors.hpp"
#include "runtime/plugin/kept_paint.hpp"
#include "runtime/plugin/painting.hpp"

namespace espalier {
namespace {

// Grammars that want another value where nothing is painted read one that is painted instead, or their own again.
void tellFill(EspContext& context, uint32_t surface, const std::string& name, float fill) {
    context.nodes.layers.change();
    const PlacedSurface& placed = *context.surfaces.find(surface);
    for (uint32_t layer = 0; layer < context.sceneLayers.size(); ++layer)
        if (context.sceneLayers[layer].name == name && context.sceneLayers[layer].fill != fill) {
            context.changes.markLayer(placed.instance, layer, placed.content->data.levels.front().size);
            context.nodes.paint.change();
        }
}

// A layer of this name for a surface that has none, filled with `fill`.
EspResult makeLayer(EspContext& context, uint32_t surface, const std::string& name, float fill, uint64_t number) {
    const uint32_t size = context.surfaces.find(surface)->content->data.levels.front().size;
    Result<Buffer> texels = Buffer::create(*context.device, "layer", uint64_t(size) * size * sizeof(float));
    if (!texels) return failGpu(&context, texels.failure());
    Result<Commands> commands = Commands::begin(*context.device, "fill layer");
    if (!commands) return failGpu(&context, commands.failure());
    commands->fill(*texels, floatBitsToUint(fill));
    Result<uint64_t> submitted = commands->submit();
    if (!submitted) return failGpu(&context, submitted.failure());
    PaintedLayer layer{name, surface, size, std::move(*texels), std::vector<float>(size_t(size) * size, fill), number};
    context.layers.push_back(std::move(layer));
    Undo untold([&] {
        context.layers.pop_back();
        context.changeWholly(context.nodes.paint);
    });
    tellFill(context, surface, name, fill);
    untold.done();
    return ESP_OK;
}

PaintStroke::Part& partOf(PaintStroke& stroke, uint32_t surface) {
    for (PaintStroke::Part& part : stroke.parts)
        if (part.surface == surface) return part;
    PaintStroke::Part& part = stroke.parts.emplace_back();
    part.surface = surface;
    return part;
}

// The parts of an ended stroke whose layers there are.
std::vector<PaintJob> jobsOf(EspContext& context, PaintStroke& stroke) {
    std::vector<PaintJob> jobs;
    for (PaintStroke::Part& part : stroke.parts)
        if (layerOf(context, stroke, part) && !part.record.blocks().empty())
            jobs.push_back({canvasOf(context, part.surface, stroke.layer), &part.record, {}});
    return jobs;
}

// Layers that the stroke has made go while it is undone, unless something else has been painted on them.
void dropMade(EspContext& context, const PaintStroke& stroke) noexcept {
    for (const PaintStroke::Part& part : stroke.parts) {
        const auto made = [&](const PaintedLayer& layer) { return layer.number == part.layer && layer.strokes == 0; };
        if (part.undone && part.made && std::erase_if(context.layers, made) > 0) context.nodes.layers.change();
    }
    dropTownMade(context, stroke);
}

// Before the stroke is done again.
EspResult makeAgain(EspContext& context, const PaintStroke& stroke) {
    for (const PaintStroke::Part& part : stroke.parts)
        if (part.undone && part.made && context.surfaces.find(part.surface) &&
            !paintedLayer(context, part.surface, stroke.layer))
            if (EspResult bad = makeLayer(context, part.surface, stroke.layer, part.fill, part.layer)) return bad;
    makeTownAgain(context, stroke);
    return ESP_OK;
}

// Notes that the stroke has been undone, or done again.
void turn(EspContext& context, PaintStroke& stroke) noexcept {
    for (PaintStroke::Part& part : stroke.parts) turnStroke(layerOf(context, stroke, part), part);
    turnTown(context, stroke);
}

// Takes back, as far as there is memory for it, what a call has painted that can't be kept.
void takeBack(EspContext& context, PaintStroke& stroke) noexcept {
    context.changeWholly(context.nodes.paint);
    swapTown(context, stroke);
    try {
        if (context.painter->swap(jobsOf(context, stroke))) swapKept(context, stroke);
    } catch (const std::bad_alloc&) {
        return;
    }
    withdraw(context, stroke);
}

}  // namespace

Canvas canvasOf(EspContext& context, uint32_t surface, const std::string& name) {
    const PlacedSurface& placed = *context.surfaces.find(surface);
    Canvas canvas;
    canvas.layer = &paintedLayer(context, surface, name)->texels;
    canvas.surface = placed.gpu.ref(placed.toWorld);
    canvas.instance = placed.instance;
    return canvas;
}

PaintedLayer* layerOf(EspContext& context, const PaintStroke& stroke, const PaintStroke::Part& part) {
    PaintedLayer* layer = paintedLayer(context, part.surface, stroke.layer);
    return layer && layer->number == part.layer ? layer : nullptr;
}

void withdraw(EspContext& context, PaintStroke& stroke) noexcept {
    turn(context, stroke);
    dropMade(context, stroke);
}

EspResult jobsFor(EspContext& context, PaintStroke& stroke, float fill, TouchedBlocks touched,
                  std::vector<PaintJob>& jobs) {
    context.device->hostSubmitted();  // as espUpdate does
    for (const auto& [surface, blocks] : touched) {
        PaintStroke::Part& part = partOf(stroke, surface);
        if (!layerOf(context, stroke, part)) {  // nothing yet, or on a layer that is gone
            part = {};
            part.surface = surface;
        }
        if (const PaintedLayer* there = paintedLayer(context, surface, stroke.layer)) {
            part.layer = there->number;
        } else {
            if (EspResult bad = makeLayer(context, surface, stroke.layer, fill, context.layersMade + 1)) return bad;
            part.layer = ++context.layersMade;
            part.made = true;
            part.fill = fill;
        }
        countStroke(layerOf(context, stroke, part), part, true);
    }
    for (auto& [surface, blocks] : touched)  // addresses stay from here on
        jobs.push_back({canvasOf(context, surface, stroke.layer), &partOf(stroke, surface).record, std::move(blocks)});
    return ESP_OK;
}

EspResult endStroke(EspContext& context, PaintStroke& stroke, const PartChanged& changed) {
    context.device->hostSubmitted();
    const bool open = std::exchange(stroke.open, false);
    const auto lost = [&](const Failure& failure) {
        stroke.open = open;
        return failGpu(&context, failure);
    };
    closeTown(context, stroke);
    for (PaintStroke::Part& part : stroke.parts) {
        if (!layerOf(context, stroke, part)) continue;
        Result<std::vector<uint64_t>> texels =
            context.painter->close(canvasOf(context, part.surface, stroke.layer), part.record);
        if (!texels && context.device->lost()) return lost(texels.failure());
        if (changed) changed(part, texels ? *texels : std::vector<uint64_t>());
    }
    if (Status kept = keepStroke(context, stroke); !kept) return lost(kept.failure());
    std::erase_if(stroke.parts, [&](PaintStroke::Part& part) {
        const bool idle = (part.record.blocks().empty() && !part.made) || !layerOf(context, stroke, part);
        if (idle) countStroke(layerOf(context, stroke, part), part, false);
        return idle;
    });
    return ESP_OK;
}

EspResult swapStroke(EspContext& context, PaintStroke& stroke) {
    if (stroke.open) return fail(&context, ESP_INVALID_ARGUMENT, "espSwapStroke: the stroke has not been ended");
    context.device->hostSubmitted();
    Undo made([&] { dropMade(context, stroke); });
    if (EspResult bad = makeAgain(context, stroke)) return bad;
    for (PaintStroke::Part& part : stroke.parts) {
        if (!layerOf(context, stroke, part)) continue;
        if (part.made) tellFill(context, part.surface, stroke.layer, part.fill);
        Result<std::vector<uint64_t>> texels =
            context.painter->differences(canvasOf(context, part.surface, stroke.layer), part.record);
        if (!texels) return failGpu(&context, texels.failure());
        layerChanged(context, part.surface, stroke.layer, part.record.blocks(), *texels);
    }
    swapTown(context, stroke);
    Undo town([&] { swapTown(context, stroke); });
    if (Status swapped = context.painter->swap(jobsOf(context, stroke)); !swapped)
        return failGpu(&context, swapped.failure());
    if (stroke.filled) std::swap(*stroke.filled, context.filled[stroke.layer]);
    town.done();
    swapKept(context, stroke);
    turn(context, stroke);
    made.done();
    dropMade(context, stroke);
    return ESP_OK;
}

EspResult keepEnded(EspContext& context, PaintStroke stroke, EspStroke* out) {
    Undo painted([&] { takeBack(context, stroke); });
    const auto changed = [&](const PaintStroke::Part& part, const std::vector<uint64_t>& texels) {
        layerChanged(context, part.surface, stroke.layer, part.record.blocks(), texels);
    };
    if (EspResult bad = endStroke(context, stroke, changed)) return bad;
    const uint32_t id = context.strokes.insert({});
    if (!id) return fail(&context, ESP_OUT_OF_MEMORY, "painting: no ids left");
    painted.done();
    *context.strokes.find(id) = std::move(stroke);
    out->id = id;
    return ESP_OK;
}

}  // namespace espalier
