// Strokes on layers: which surfaces a brush reaches, what a stroke keeps.
#include <algorithm>
#include <cmath>
#include <numeric>

#include "runtime/core/undo.hpp"
#include "runtime/plugin/context.hpp"

namespace espalier {
namespace {

constexpr uint32_t kMaxDabs = 1u << 16;  // of one call
constexpr float kMostReach = 16;         // texels: what a texel tells of borders ends a little farther out

bool usable(const EspDab& dab) {
    for (int i = 0; i < 3; ++i)
        if (!std::isfinite(dab.position[i]) || !std::isfinite(dab.normal[i])) return false;
    return dab.pressure >= 0 && dab.pressure <= 1;
}

const BlockBounds& boundsOf(PlacedSurface& surface) {
    if (!surface.blocks) surface.blocks = BlockBounds(surface.data.levels.front());
    return surface.blocks;
}

EspResult makePainter(EspContext& context) {
    if (context.painter) return ESP_OK;
    Result<std::unique_ptr<Painter>> painter = Painter::create(*context.device);
    if (!painter) return failGpu(&context, painter.failure());
    context.painter = std::move(*painter);
    return ESP_OK;
}

// Grammars that want another value where nothing is painted read one that is painted instead, or their own again.
void tellFill(EspContext& context, uint32_t surface, const std::string& name, float fill) {
    context.tablesStale = true;
    const PlacedSurface& placed = *context.surfaces.find(surface);
    for (uint32_t layer = 0; layer < context.sceneLayers.size(); ++layer)
        if (context.sceneLayers[layer].name == name && context.sceneLayers[layer].fill != fill) {
            context.changes.markLayer(placed.instance, layer, placed.data.levels.front().size);
            ++context.revision;
        }
}

// A layer of this name for a surface that has none, filled with `fill`.
EspResult makeLayer(EspContext& context, uint32_t surface, const std::string& name, float fill, uint64_t number) {
    const uint32_t size = context.surfaces.find(surface)->data.levels.front().size;
    Result<Buffer> texels = Buffer::create(*context.device, "layer", uint64_t(size) * size * sizeof(float));
    if (!texels) return failGpu(&context, texels.failure());
    Result<Commands> commands = Commands::begin(*context.device, "fill layer");
    if (!commands) return failGpu(&context, commands.failure());
    commands->fill(*texels, floatBitsToUint(fill));
    Result<uint64_t> submitted = commands->submit();
    if (!submitted) return failGpu(&context, submitted.failure());
    context.layers.push_back({name, surface, size, std::move(*texels), number, 0});
    tellFill(context, surface, name, fill);
    return ESP_OK;
}

Canvas canvasOf(EspContext& context, uint32_t surface, const std::string& name) {
    const PlacedSurface& placed = *context.surfaces.find(surface);
    Canvas canvas;
    canvas.layer = &paintedLayer(context, surface, name)->texels;
    canvas.surface = placed.gpu.ref(placed.toWorld);
    canvas.instance = placed.instance;
    return canvas;
}

// Of each block the texels that lie within a dab's radius, bit 8 y + x.
std::vector<uint64_t> texelsWithin(const PlacedSurface& surface, std::span<const uint32_t> blocks,
                                   std::span<const DabRecord> dabs, float radius) {
    const float reach = radius / surface.scale * 1.001f;  // the kernel rounds otherwise
    std::vector<glm::vec3> centres;
    for (const DabRecord& dab : dabs) centres.push_back(surface.toObject * glm::vec4(dab.position, 1));
    std::vector<uint64_t> within;
    for (uint32_t block : blocks) {
        const std::span texels = std::span(surface.data.levels.front().texels).subspan(size_t(block) * kBlockTexels);
        uint64_t& mask = within.emplace_back(0);
        for (uint32_t i = 0; i < kBlockTexels; ++i)
            for (const glm::vec3& centre : centres)
                if (glm::distance(texels[i].position, centre) < reach) mask |= uint64_t(1) << i;
    }
    return within;
}

// Whether plants ask for the layer.
bool plantsRead(const EspContext& context, const std::string& name) {
    bool read = false;
    context.grammars.forEach([&](uint32_t, const LoadedGrammar& grammar) {
        read = read || (!grammar.map.roofs() && grammar.map.findContext(name));
    });
    return read;
}

PaintStroke::Part& partOf(PaintStroke& stroke, uint32_t surface) {
    for (PaintStroke::Part& part : stroke.parts)
        if (part.surface == surface) return part;
    PaintStroke::Part& part = stroke.parts.emplace_back();
    part.surface = surface;
    return part;
}

using Touched = std::vector<std::pair<uint32_t, std::vector<uint32_t>>>;  // surface id, blocks

// Makes the layers that are missing, and what the painter asks for.
EspResult jobsFor(EspContext& context, PaintStroke& stroke, float fill, Touched touched, std::vector<PaintJob>& jobs) {
    context.device->hostSubmitted();  // as espUpdate does
    for (const auto& [surface, blocks] : touched) {
        PaintStroke::Part& part = partOf(stroke, surface);
        if (paintedLayer(context, surface, stroke.layer)) continue;
        if (EspResult bad = makeLayer(context, surface, stroke.layer, fill, context.layersMade + 1)) return bad;
        part.made = ++context.layersMade;
        part.fill = fill;
    }
    for (auto& [surface, blocks] : touched)  // addresses stay from here on
        jobs.push_back({canvasOf(context, surface, stroke.layer), &partOf(stroke, surface).record, std::move(blocks)});
    return ESP_OK;
}

EspResult begin(EspContext& context, const EspBrush& brush, EspStroke* out) {
    if (const char* mistake = mistakeIn(brush))
        return fail(&context, ESP_INVALID_ARGUMENT, std::string("espBeginStroke: ") + mistake);
    if (EspResult bad = makePainter(context)) return bad;
    PaintStroke stroke;
    stroke.layer = brush.layer;
    stroke.radius = brush.radius;
    stroke.smooths = brush.mode == ESP_BRUSH_SMOOTH;
    stroke.erases = brush.mode == ESP_BRUSH_ERASE;
    float erased = 0;
    if (!espLayerFilled(&context, brush.layer, &erased)) erased = declaredFill(context, brush.layer).value_or(0);
    stroke.brush = recordOf(brush, erased);
    out->id = context.strokes.insert(std::move(stroke));
    return out->id ? ESP_OK : fail(&context, ESP_OUT_OF_MEMORY, "espBeginStroke: no ids left");
}

// Metres that a texel of the surface covers, in the mean.
float texelOf(const PlacedSurface& surface) {
    double metres = 0, area = 0;
    for (const Chart& chart : surface.data.charts) {
        metres += double(chart.metresPerUv) * double(chart.area);
        area += chart.area;
    }
    return float(metres / std::max(area, 1e-20)) * surface.scale / float(surface.data.levels.front().size);
}

// Near borders smoothing walks, so it needs the table of surfaces; ways are a texel and a half long at least.
Status smooth(EspContext& context, std::vector<PaintJob>& jobs, const PaintStroke& stroke,
              std::span<const DabRecord> dabs) {
    Status tables = context.refreshTables();
    if (!tables) return tables;
    Status smoothed = Done{};
    for (PaintJob& job : jobs) {
        job.canvas.surfaces.v = reinterpret_cast<SurfaceRef*>(context.surfaceTable.address());
        Reach reach;
        context.surfaces.forEach([&](uint32_t, const PlacedSurface& surface) {
            if (surface.instance != job.canvas.instance) return;
            const float texel = texelOf(surface);
            reach.texels = std::clamp(kSmoothReach * stroke.radius / texel, 1.5f, kMostReach);
            reach.metres = reach.texels * texel;
        });
        if (smoothed) smoothed = context.painter->smooth(job, reach, stroke.brush, dabs);
    }
    return smoothed;
}

EspResult applyDabs(EspContext& context, PaintStroke& stroke, std::span<const EspDab> dabs) {
    std::vector<DabRecord> records;
    for (const EspDab& dab : dabs) {
        if (!usable(dab))
            return fail(&context, ESP_INVALID_ARGUMENT,
                        "espStrokeDabs: a dab is not finite, or its pressure not within 0 to 1");
        records.push_back({{dab.position[0], dab.position[1], dab.position[2]},
                           dab.pressure,
                           {dab.normal[0], dab.normal[1], dab.normal[2]},
                           0});
    }
    // What is for roofs alone makes no layers on surfaces that happen to be near.
    const bool roofsOnly = paintTown(context, stroke, records) && !plantsRead(context, stroke.layer);
    Touched touched;
    context.surfaces.forEach([&](uint32_t id, PlacedSurface& surface) {
        if (roofsOnly && !paintedLayer(context, id, stroke.layer)) return;
        std::vector<uint32_t> blocks;
        for (const DabRecord& dab : records)
            boundsOf(surface).near(glm::vec3(surface.toObject * glm::vec4(dab.position, 1)),
                                   stroke.radius / surface.scale, blocks);
        std::ranges::sort(blocks);
        blocks.erase(std::unique(blocks.begin(), blocks.end()), blocks.end());
        if (!blocks.empty()) touched.push_back({id, std::move(blocks)});
    });
    if (touched.empty()) return ESP_OK;
    std::vector<PaintJob> jobs;
    const float fill = declaredFill(context, stroke.layer).value_or(0);
    if (EspResult bad = jobsFor(context, stroke, fill, touched, jobs)) return bad;
    Status painted =
        stroke.smooths ? smooth(context, jobs, stroke, records) : context.painter->dabs(jobs, stroke.brush, records);
    for (const auto& [id, blocks] : touched) {  // smoothing that failed may have come to some of the surfaces
        const PlacedSurface& surface = *context.surfaces.find(id);
        layerChanged(context, id, stroke.layer, blocks, texelsWithin(surface, blocks, records, stroke.radius));
    }
    return painted ? ESP_OK : failGpu(&context, painted.failure());
}

// The parts of an ended stroke whose layers there are.
std::vector<PaintJob> jobsOf(EspContext& context, PaintStroke& stroke) {
    std::vector<PaintJob> jobs;
    for (PaintStroke::Part& part : stroke.parts)
        if (paintedLayer(context, part.surface, stroke.layer) && !part.record.blocks().empty())
            jobs.push_back({canvasOf(context, part.surface, stroke.layer), &part.record, {}});
    return jobs;
}

// Layers that the stroke has made go while it is undone, unless something else has been painted on them.
void dropMade(EspContext& context, const PaintStroke& stroke) noexcept {
    for (const PaintStroke::Part& part : stroke.parts) {
        const auto made = [&](const PaintedLayer& layer) { return layer.number == part.made && layer.strokes == 0; };
        if (part.undone && part.made != 0 && std::erase_if(context.layers, made) > 0) context.tablesStale = true;
    }
}

// Before the stroke is done again.
EspResult makeAgain(EspContext& context, const PaintStroke& stroke) {
    for (const PaintStroke::Part& part : stroke.parts)
        if (part.undone && part.made != 0 && context.surfaces.find(part.surface) &&
            !paintedLayer(context, part.surface, stroke.layer))
            if (EspResult bad = makeLayer(context, part.surface, stroke.layer, part.fill, part.made)) return bad;
    return ESP_OK;
}

// Notes that the stroke has been undone, or done again.
void turn(EspContext& context, PaintStroke& stroke) noexcept {
    for (PaintStroke::Part& part : stroke.parts)
        if (PaintedLayer* layer = paintedLayer(context, part.surface, stroke.layer)) {
            part.undone = !part.undone;
            layer->strokes += part.undone ? -1 : 1;
        }
}

// Notes that an ended stroke has painted on its layers.
void countOn(EspContext& context, const PaintStroke& stroke) {
    for (const PaintStroke::Part& part : stroke.parts)
        if (PaintedLayer* layer = paintedLayer(context, part.surface, stroke.layer)) ++layer->strokes;
}

// `changed` is told of each part's blocks that aren't as they were, and which of their texels. Where there is no memory
// to look, the record keeps all of its blocks, and all of their texels count as changed.
template <class Changed>
EspResult end(EspContext& context, PaintStroke& stroke, Changed&& changed) {
    context.device->hostSubmitted();
    stroke.open = false;
    closeTown(context, stroke);
    for (PaintStroke::Part& part : stroke.parts) {
        if (!paintedLayer(context, part.surface, stroke.layer)) continue;
        Result<std::vector<uint64_t>> texels =
            context.painter->close(canvasOf(context, part.surface, stroke.layer), part.record);
        if (!texels && context.device->lost()) return failGpu(&context, texels.failure());
        changed(part, texels ? *texels : std::vector<uint64_t>());
    }
    std::erase_if(stroke.parts,
                  [](const PaintStroke::Part& part) { return part.record.blocks().empty() && part.made == 0; });
    countOn(context, stroke);
    return ESP_OK;
}

// All of it or nothing.
EspResult swap(EspContext& context, PaintStroke& stroke) {
    if (stroke.open) return fail(&context, ESP_INVALID_ARGUMENT, "espSwapStroke: the stroke has not been ended");
    context.device->hostSubmitted();
    Undo made([&] { dropMade(context, stroke); });
    if (EspResult bad = makeAgain(context, stroke)) return bad;
    for (PaintStroke::Part& part : stroke.parts) {
        const PaintedLayer* layer = paintedLayer(context, part.surface, stroke.layer);
        if (!layer) continue;
        if (part.made != 0 && layer->number == part.made) tellFill(context, part.surface, stroke.layer, part.fill);
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
    turn(context, stroke);
    made.done();
    dropMade(context, stroke);
    return ESP_OK;
}

// Takes back, as far as there is memory for it, what a call has painted that can't be kept.
void takeBack(EspContext& context, PaintStroke& stroke) noexcept {
    context.touch();
    swapTown(context, stroke);
    try {
        (void)context.painter->swap(jobsOf(context, stroke));
    } catch (const std::bad_alloc&) {
    }
}

// Ends a stroke that painted in one go, and gives it an id.
EspResult keepEnded(EspContext& context, PaintStroke stroke, EspStroke* out) {
    Undo painted([&] { takeBack(context, stroke); });
    const auto changed = [&](const PaintStroke::Part& part, const std::vector<uint64_t>& texels) {
        layerChanged(context, part.surface, stroke.layer, part.record.blocks(), texels);
    };
    if (EspResult bad = end(context, stroke, changed)) return bad;
    const uint32_t id = context.strokes.insert({});
    if (!id) return fail(&context, ESP_OUT_OF_MEMORY, "painting: no ids left");
    painted.done();
    *context.strokes.find(id) = std::move(stroke);
    out->id = id;
    return ESP_OK;
}

// Whether a layer that isn't painted has this value for all grammars that read it.
bool readAs(const EspContext& context, const std::string& name, float value) {
    return declaredFill(context, name).value_or(0) == value &&
           std::ranges::none_of(context.sceneLayers,
                                [&](const SceneLayer& layer) { return layer.name == name && layer.fill != value; });
}

// Of a layer of so many texels a side, those beside charts too: whoever exports it sees them.
std::vector<uint32_t> allBlocks(uint32_t side) {
    std::vector<uint32_t> blocks(size_t(side) * side / kBlockTexels);
    std::iota(blocks.begin(), blocks.end(), 0u);
    return blocks;
}

EspResult fillLayer(EspContext& context, const char* name, float value, EspStroke* out) {
    if (EspResult bad = makePainter(context)) return bad;
    PaintStroke stroke;
    stroke.layer = name;
    std::optional<float>& filled = context.filled[name];
    stroke.filled = filled;
    const bool roofsOnly = fillTown(context, stroke, value) && !plantsRead(context, name);
    Undo town([&] { swapTown(context, stroke); });
    Touched touched;
    context.surfaces.forEach([&](uint32_t id, PlacedSurface& surface) {
        if ((roofsOnly || readAs(context, name, value)) && !paintedLayer(context, id, name)) return;
        touched.push_back({id, allBlocks(surface.data.levels.front().size)});
    });
    std::vector<PaintJob> jobs;
    const float fill = declaredFill(context, name).value_or(0);
    if (EspResult bad = jobsFor(context, stroke, fill, touched, jobs)) return bad;
    if (Status painted = context.painter->fill(jobs, value); !painted) return failGpu(&context, painted.failure());
    town.done();
    if (EspResult bad = keepEnded(context, std::move(stroke), out)) return bad;
    filled = value;
    return ESP_OK;
}

}  // namespace

EspResult replaceLayer(EspContext& context, uint32_t surface, const std::string& name, std::span<const float> texels,
                       EspStroke* out) {
    if (EspResult bad = makePainter(context)) return bad;
    PaintStroke stroke;
    stroke.layer = name;
    const uint32_t side = context.surfaces.find(surface)->data.levels.front().size;
    std::vector<PaintJob> jobs;
    const float fill = declaredFill(context, name).value_or(0);
    if (EspResult bad = jobsFor(context, stroke, fill, {{surface, allBlocks(side)}}, jobs)) return bad;
    Status replaced = context.painter->replace(jobs.front(), texels);
    if (!replaced) return failGpu(&context, replaced.failure());
    return keepEnded(context, std::move(stroke), out);
}

}  // namespace espalier

using namespace espalier;

extern "C" {

EspResult espBeginStroke(EspContext* context, const EspBrush* brush, EspStroke* out) {
    return guarded(context, [&] {
        if (!brush || !out) return fail(context, ESP_INVALID_ARGUMENT, "espBeginStroke: null pointer");
        return begin(*context, *brush, out);
    });
}

EspResult espStrokeDabs(EspContext* context, EspStroke id, const EspDab* dabs, uint32_t count) {
    return guarded(context, [&] {
        PaintStroke* stroke = context->strokes.find(id.id);
        if (!stroke || !stroke->open)
            return fail(context, ESP_INVALID_ARGUMENT, "espStrokeDabs: no such stroke, or it has been ended");
        if ((!dabs && count) || count > kMaxDabs)
            return fail(context, ESP_INVALID_ARGUMENT, "espStrokeDabs: null pointer, or more than 65536 dabs");
        return applyDabs(*context, *stroke, {dabs, count});
    });
}

EspResult espEndStroke(EspContext* context, EspStroke id) {
    return guarded(context, [&] {
        PaintStroke* stroke = context->strokes.find(id.id);
        if (!stroke || !stroke->open)
            return fail(context, ESP_INVALID_ARGUMENT, "espEndStroke: no such stroke, or it has been ended before");
        return end(*context, *stroke, [](const auto&, const auto&) {});  // its dabs have told
    });
}

EspResult espSwapStroke(EspContext* context, EspStroke id) {
    return guarded(context, [&] {
        PaintStroke* stroke = context->strokes.find(id.id);
        if (!stroke) return fail(context, ESP_INVALID_ARGUMENT, "espSwapStroke: no such stroke");
        return swap(*context, *stroke);
    });
}

EspResult espDestroyStroke(EspContext* context, EspStroke id) {
    return guarded(context, [&] {
        const PaintStroke* stroke = context->strokes.find(id.id);
        if (!stroke) return fail(context, ESP_INVALID_ARGUMENT, "espDestroyStroke: no such stroke");
        if (stroke->open) countOn(*context, *stroke);
        context->strokes.erase(id.id);
        return ESP_OK;
    });
}

uint64_t espStrokeBytes(const EspContext* context, EspStroke id) {
    const PaintStroke* stroke = context ? context->strokes.find(id.id) : nullptr;
    uint64_t bytes = stroke ? stroke->plan.bytes() : 0;
    if (stroke)
        for (const PaintStroke::Part& part : stroke->parts) bytes += part.record.bytes();
    return bytes;
}

EspResult espFillLayer(EspContext* context, const char* layer, float value, EspStroke* out) {
    return guarded(context, [&] {
        if (!layer || !*layer || !out || !(value >= 0 && value <= 1))
            return fail(context, ESP_INVALID_ARGUMENT, "espFillLayer: null pointer, no name, or a value beyond 0 to 1");
        return fillLayer(*context, layer, value, out);
    });
}

int espLayerFilled(const EspContext* context, const char* layer, float* value) {
    if (!context || !layer || !value) return 0;
    const auto found = context->filled.find(layer);
    if (found == context->filled.end() || !found->second) return 0;
    *value = *found->second;
    return 1;
}

}  // extern "C"
