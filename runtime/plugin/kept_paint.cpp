// In: layers and records on a device. Out: the same on the host, and from there on another device.
#include "runtime/plugin/kept_paint.hpp"

#include <new>

#include "runtime/plugin/errors.hpp"
#include "runtime/plugin/painting.hpp"
#include "runtime/plugin/strokes.hpp"

namespace espalier {
namespace {

// False: memory was short for it, and nothing of the host's has changed but that the record has no copy.
Result<bool> keepPart(EspContext& context, const PaintStroke& stroke, PaintStroke::Part& part, PaintedLayer& layer) {
    try {
        Status kept =
            context.painter->keep(canvasOf(context, part.surface, stroke.layer), part.record, std::span(layer.kept));
        if (!kept && context.device->lost()) return kept.failure();
        return bool(kept);
    } catch (const std::bad_alloc&) {
        return false;
    }
}

Result<bool> keepLayer(EspContext& context, PaintedLayer& layer) {
    try {
        Result<std::vector<float>> texels =
            readVector<float>(*context.device, layer.texels, 0, size_t(layer.size) * layer.size);
        if (!texels && context.device->lost()) return texels.failure();
        if (texels) layer.kept = std::move(*texels);
        return bool(texels);
    } catch (const std::bad_alloc&) {
        return false;
    }
}

EspResult restoreLayer(EspContext& context, PaintedLayer& layer) {
    if (layer.behind)
        context.log(Severity::warning,
                    "layer '" + layer.name + "': memory was too short to keep what was painted last, which is lost");
    layer.behind = false;
    Status made = assign(layer.texels, makeBuffer(*context.device, "layer", layer.kept));
    return made ? ESP_OK : failGpu(&context, made.failure());
}

// Of an open one nothing is on the layer: its dabs paint that again, and it stays open.
EspResult restoreStroke(EspContext& context, PaintStroke& stroke) {
    for (PaintStroke::Part& part : stroke.parts) {
        if (!stroke.open && !part.record.isKept())
            context.log(Severity::warning, "layer '" + stroke.layer +
                                               "': memory was too short to keep what was there " +
                                               "before a stroke, which can't be undone any more");
        if (stroke.open || !part.record.isKept()) part.record = {};
        if (Status restored = context.painter->restore(part.record); !restored)
            return failGpu(&context, restored.failure());
    }
    return stroke.open ? paintAgain(context, stroke) : ESP_OK;
}

// The host's copies are again as they were before these parts.
void takeBackKept(EspContext& context, PaintStroke& stroke, std::span<PaintStroke::Part> parts) noexcept {
    for (PaintStroke::Part& part : parts)
        if (PaintedLayer* layer = layerOf(context, stroke, part); layer && part.record.isKept()) {
            part.record.swapKept(layer->kept);
            part.record.dropKept();
        }
}

// Copies all of a layer for which there was no memory, though its surface be away. False: there still is none.
Result<bool> catchUp(EspContext& context, PaintedLayer& layer) {
    if (!layer.behind) return true;
    Result<bool> kept = keepLayer(context, layer);
    if (kept) layer.behind = !*kept;
    return kept;
}

}  // namespace

Status keepStroke(EspContext& context, PaintStroke& stroke) {
    for (size_t i = 0; i < stroke.parts.size(); ++i) {
        PaintStroke::Part& part = stroke.parts[i];
        PaintedLayer* layer = layerOf(context, stroke, part);
        if (!layer) continue;
        Result<bool> kept = keepPart(context, stroke, part, *layer);
        if (!kept) {
            takeBackKept(context, stroke, std::span(stroke.parts).first(i));
            return kept.failure();
        }
        if (!*kept) layer->behind = context.paintBehind = true;
    }
    letGo(stroke.dabs);
    return Done{};
}

void swapKept(EspContext& context, PaintStroke& stroke) noexcept {
    for (PaintStroke::Part& part : stroke.parts) {
        PaintedLayer* layer = layerOf(context, stroke, part);
        if (!layer || part.record.blocks().empty()) continue;
        if (part.record.isKept() && !layer->behind) {
            part.record.swapKept(layer->kept);
            continue;
        }
        part.record.dropKept();
        layer->behind = context.paintBehind = true;
    }
}

Status keepBehind(EspContext& context) {
    if (!context.paintBehind) return Done{};
    bool painting = false;  // then what is on layers is known by dabs, too
    context.strokes.forEach([&](uint32_t, const PaintStroke& stroke) { painting = painting || !stroke.dabs.empty(); });
    if (painting) return Done{};
    bool all = true;
    Status status = Done{};
    const auto take = [&](PaintedLayer& layer) {
        if (!status) return;
        Result<bool> kept = catchUp(context, layer);
        if (!kept) status = kept.failure();
        all = all && kept && *kept;
    };
    for (PaintedLayer& layer : context.layers) take(layer);
    if (context.streaming)
        for (PaintedLayer* layer : context.streaming->layersAway()) take(*layer);
    context.strokes.forEach([&](uint32_t, PaintStroke& stroke) {
        if (stroke.open || !status) return;
        for (PaintStroke::Part& part : stroke.parts) {
            PaintedLayer* layer = layerOf(context, stroke, part);
            if (part.record.isKept() || !status) continue;
            if (!layer) {  // gone, or its surface is away: once it is back
                all = all && !(context.streaming && context.streaming->knows(part.surface));
                continue;
            }
            Result<bool> kept = keepPart(context, stroke, part, *layer);
            if (!kept) status = kept.failure();
            all = all && kept && *kept;
        }
    });
    context.paintBehind = !all;
    return status;
}

EspResult restorePaint(EspContext& context) {
    for (PaintedLayer& layer : context.layers)
        if (EspResult bad = restoreLayer(context, layer)) return bad;
    if (context.streaming)
        for (PaintedLayer* layer : context.streaming->layersAway())
            if (EspResult bad = restoreLayer(context, *layer)) return bad;
    context.paintBehind = false;
    if (context.strokes.size() == 0) return ESP_OK;
    if (EspResult bad = makePainter(context)) return bad;
    EspResult first = ESP_OK;
    context.strokes.forEach([&](uint32_t, PaintStroke& stroke) {
        if (first == ESP_OK) first = restoreStroke(context, stroke);
    });
    return first;
}

}  // namespace espalier
