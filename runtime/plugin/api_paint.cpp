// The C ABI's strokes and fills: which surfaces a brush reaches, and which texels.
#include <algorithm>
#include <cmath>
#include <numeric>

#include "runtime/core/undo.hpp"
#include "runtime/plugin/errors.hpp"
#include "runtime/plugin/given.hpp"
#include "runtime/plugin/painting.hpp"
#include "runtime/plugin/strokes.hpp"

namespace espalier {
namespace {

constexpr uint32_t kMaxDabs = 1u << 16;  // of one call
constexpr float kFarthestDab = 1e12f;    // metres: nothing lies so far away, and squares of distances are still floats
constexpr float kMostReach = 16;         // texels: what a texel tells of borders ends a little farther out

bool usable(const EspDab& dab) {
    return finite(dab.position) && finite(dab.normal) && dab.pressure >= 0 && dab.pressure <= 1;
}

const BlockBounds& boundsOf(PlacedSurface& surface) {
    if (!surface.content->blocks) surface.content->blocks = BlockBounds(surface.content->data.levels.front());
    return surface.content->blocks;
}

// Where a dab lies in object space, and as far as it may reach there: the kernel, which measures in the world, rounds
// otherwise.
struct Reached {
    glm::vec3 centre;
    float radius;
};
std::vector<Reached> reachedBy(const PlacedSurface& surface, std::span<const DabRecord> dabs, float radius) {
    constexpr float kRounding = 1e-6f;  // of coordinates, some steps of a float
    std::vector<Reached> reached;
    for (const DabRecord& dab : dabs)
        reached.push_back({glm::vec3(surface.toObject * glm::vec4(dab.position, 1)),
                           (1.001f * radius + kRounding * (glm::length(dab.position) + radius)) / surface.scale});
    return reached;
}

// Of each block the texels that a dab may reach, bit 8 y + x.
std::vector<uint64_t> texelsWithin(const PlacedSurface& surface, std::span<const uint32_t> blocks,
                                   std::span<const Reached> dabs) {
    std::vector<uint64_t> within;
    for (uint32_t block : blocks) {
        const std::span texels =
            std::span(surface.content->data.levels.front().texels).subspan(size_t(block) * kBlockTexels);
        uint64_t& mask = within.emplace_back(0);
        for (uint32_t i = 0; i < kBlockTexels; ++i)
            for (const Reached& dab : dabs)
                if (glm::distance(texels[i].position, dab.centre) < dab.radius) mask |= uint64_t(1) << i;
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

EspResult begin(EspContext& context, const EspBrush& brush, EspStroke* out) {
    if (const char* mistake = espalier::mistakeIn(brush))
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
    for (const Chart& chart : surface.content->data.charts) {
        metres += double(chart.metresPerUv) * double(chart.area);
        area += chart.area;
    }
    return float(metres / std::max(area, 1e-20)) * surface.scale / float(surface.content->data.levels.front().size);
}

// Near borders smoothing walks, so it needs the table of surfaces; ways are a texel and a half long at least.
Status smooth(EspContext& context, std::vector<PaintJob>& jobs, const PaintStroke& stroke,
              std::span<const DabRecord> dabs) {
    Status tables = context.refreshTables();
    if (!tables) return tables;
    Status smoothed = Done{};
    for (PaintJob& job : jobs) {
        job.canvas.surfaces = addressOf<SurfaceBuf>(context.surfaceTable);
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

EspResult paintSurfaces(EspContext& context, PaintStroke& stroke, std::span<const DabRecord> dabs, bool roofsOnly) {
    TouchedBlocks touched;
    context.surfaces.forEach([&](uint32_t id, PlacedSurface& surface) {
        if (roofsOnly && !paintedLayer(context, id, stroke.layer)) return;
        std::vector<uint32_t> blocks;
        for (const Reached& dab : reachedBy(surface, dabs, stroke.radius))
            boundsOf(surface).near(dab.centre, dab.radius, blocks);
        std::ranges::sort(blocks);
        blocks.erase(std::unique(blocks.begin(), blocks.end()), blocks.end());
        if (!blocks.empty()) touched.push_back({id, std::move(blocks)});
    });
    if (touched.empty()) return ESP_OK;
    std::vector<PaintJob> jobs;
    const float fill = declaredFill(context, stroke.layer).value_or(0);
    if (EspResult bad = jobsFor(context, stroke, fill, touched, jobs)) return bad;
    Undo untold([&] { context.changeWholly(context.nodes.paint); });
    Status painted =
        stroke.smooths ? smooth(context, jobs, stroke, dabs) : context.painter->dabs(jobs, stroke.brush, dabs);
    for (const auto& [id, blocks] : touched) {  // smoothing that failed may have come to some of the surfaces
        const PlacedSurface& surface = *context.surfaces.find(id);
        const std::vector<Reached> reached = reachedBy(surface, dabs, stroke.radius);
        layerChanged(context, id, stroke.layer, blocks, texelsWithin(surface, blocks, reached));
    }
    untold.done();
    return painted ? ESP_OK : failGpu(&context, painted.failure());
}

// Blocks that a dab reaches are gone through for all that come with it. notes: the stroke notes what is painted.
EspResult paintInTurns(EspContext& context, PaintStroke& stroke, std::span<const DabRecord> dabs, bool notes) {
    for (size_t first = 0; first < dabs.size(); first += kDabsAtOnce) {
        const std::span some = dabs.subspan(first, std::min<size_t>(kDabsAtOnce, dabs.size() - first));
        if (EspResult bad = paintSurfaces(context, stroke, some, stroke.roofsOnly)) return bad;
        if (notes) stroke.dabs.insert(stroke.dabs.end(), some.begin(), some.end());
    }
    return ESP_OK;
}

EspResult applyDabs(EspContext& context, PaintStroke& stroke, std::span<const EspDab> dabs) {
    std::vector<DabRecord> records;
    for (const EspDab& dab : dabs) {
        if (!usable(dab))
            return fail(&context, ESP_INVALID_ARGUMENT,
                        "espStrokeDabs: a dab is not finite, or its pressure not within 0 to 1");
        const glm::vec3 at = vec(dab.position);
        if (glm::length(at / kFarthestDab) > 1) continue;
        records.push_back({at, dab.pressure, vec(dab.normal), 0});
    }
    // What is for roofs alone makes no layers on surfaces that happen to be near.
    stroke.roofsOnly = townTakes(context, stroke.layer) && !plantsRead(context, stroke.layer);
    const size_t before = stroke.dabs.size();
    if (const size_t needed = before + records.size(); needed > stroke.dabs.capacity())
        stroke.dabs.reserve(std::max(needed, 2 * before));
    if (EspResult bad = paintInTurns(context, stroke, records, true)) {
        if (bad == ESP_DEVICE_LOST) stroke.dabs.resize(before);  // another device won't have them
        return bad;
    }
    paintTown(context, stroke, records);
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
    Undo made([&] { withdraw(context, stroke); });
    Undo town([&] { swapTown(context, stroke); });
    const bool roofsOnly = fillTown(context, stroke, value) && !plantsRead(context, name);
    TouchedBlocks touched;
    context.surfaces.forEach([&](uint32_t id, PlacedSurface& surface) {
        if ((roofsOnly || readAs(context, name, value)) && !paintedLayer(context, id, name)) return;
        touched.push_back({id, allBlocks(surface.content->data.levels.front().size)});
    });
    std::vector<PaintJob> jobs;
    const float fill = declaredFill(context, name).value_or(0);
    if (EspResult bad = jobsFor(context, stroke, fill, touched, jobs)) return bad;
    if (Status painted = context.painter->fill(jobs, value); !painted) return failGpu(&context, painted.failure());
    made.done();
    town.done();
    if (EspResult bad = keepEnded(context, std::move(stroke), out)) return bad;
    filled = value;
    return ESP_OK;
}

}  // namespace

EspResult makePainter(EspContext& context) {
    if (context.painter) return ESP_OK;
    Result<std::unique_ptr<Painter>> painter = Painter::create(*context.device);
    if (!painter) return failGpu(&context, painter.failure());
    context.painter = std::move(*painter);
    return ESP_OK;
}

EspResult paintAgain(EspContext& context, PaintStroke& stroke) {
    return paintInTurns(context, stroke, stroke.dabs, false);
}

EspResult replaceLayer(EspContext& context, uint32_t surface, const std::string& name, std::span<const float> texels,
                       EspStroke* out) {
    if (EspResult bad = makePainter(context)) return bad;
    PaintStroke stroke;
    stroke.layer = name;
    const uint32_t side = context.surfaces.find(surface)->content->data.levels.front().size;
    std::vector<PaintJob> jobs;
    const float fill = declaredFill(context, name).value_or(0);
    Undo made([&] { withdraw(context, stroke); });
    if (EspResult bad = jobsFor(context, stroke, fill, {{surface, allBlocks(side)}}, jobs)) return bad;
    Status replaced = context.painter->replace(jobs.front(), texels);
    if (!replaced) return failGpu(&context, replaced.failure());
    made.done();
    return keepEnded(context, std::move(stroke), out);
}

}  // namespace espalier

using namespace espalier;

extern "C" {

EspResult espBeginStroke(EspContext* context, const EspBrush* brush, EspStroke* out) {
    return guarded(context, [&] {
        if (!out) return fail(context, ESP_INVALID_ARGUMENT, "espBeginStroke: null pointer");
        return begin(*context, taken("espBeginStroke", brush), out);
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
        return endStroke(*context, *stroke);  // its dabs have told
    });
}

EspResult espSwapStroke(EspContext* context, EspStroke id) {
    return guarded(context, [&] {
        PaintStroke* stroke = context->strokes.find(id.id);
        if (!stroke) return fail(context, ESP_INVALID_ARGUMENT, "espSwapStroke: no such stroke");
        return swapStroke(*context, *stroke);
    });
}

EspResult espDestroyStroke(EspContext* context, EspStroke id) {
    return guarded(context, [&] {
        if (!context->strokes.find(id.id))
            return fail(context, ESP_INVALID_ARGUMENT, "espDestroyStroke: no such stroke");
        context->strokes.erase(id.id);
        return ESP_OK;
    });
}

uint64_t espStrokeBytes(const EspContext* context, EspStroke id) {
    const PaintStroke* stroke = context ? context->strokes.find(id.id) : nullptr;
    uint64_t bytes = stroke ? stroke->plan.record.bytes() : 0;
    if (stroke)
        for (const PaintStroke::Part& part : stroke->parts) bytes += part.record.bytes();
    return bytes;
}

int espStrokePainted(const EspContext* context, EspStroke id, EspSurface surface) {
    const PaintStroke* stroke = context ? context->strokes.find(id.id) : nullptr;
    if (!stroke) return 0;
    const auto painted = [&](const PaintStroke::Part& part) {
        return part.surface == surface.id && !part.record.blocks().empty();
    };
    return surface.id ? std::ranges::any_of(stroke->parts, painted) : !stroke->plan.record.blocks.empty();
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
    const auto found = context->filled.find(std::string_view(layer));
    if (found == context->filled.end() || !found->second) return 0;
    *value = *found->second;
    return 1;
}

}  // extern "C"
