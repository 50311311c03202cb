// In: a context whose device was lost, and another device. Out: the same context on that one.
#include <map>

#include "runtime/plugin/context.hpp"
#include "runtime/plugin/device_parts.hpp"
#include "runtime/plugin/errors.hpp"
#include "runtime/plugin/furnishing.hpp"
#include "runtime/plugin/kept_paint.hpp"
#include "runtime/plugin/looks.hpp"

namespace espalier {
namespace {

using Evaluations = std::map<uint32_t, std::unique_ptr<NodeEvaluation>>;  // by ids of graphs

EspResult evaluationsOn(EspContext& context, Device& device, Evaluations& out) {
    EspResult first = ESP_OK;
    context.graphs.graphs.forEach([&](uint32_t id, const LoadedGraph& graph) {
        Result<std::unique_ptr<NodeEvaluation>> made = sameOn(context, graph, device);
        if (made)
            out[id] = std::move(*made);
        else if (first == ESP_OK)
            first = failWork(&context, made.failure());
    });
    return first;
}

// What lies on the device goes; what a host has made of the context, and what was painted, stays. Where memory is too
// short for this, it may be called again.
void letGoOfDevice(EspContext& context) {
    context.graphs.graphs.forEach([](uint32_t, LoadedGraph& graph) { graph.stands.letGoOfMeshes(); });
    if (context.streaming) context.streaming->endLoads();
    if (context.loads) context.loads->beginAnew();
    context.surfaces.forEach([](uint32_t, PlacedSurface& surface) { surface.gpu = {}; });
    for (PaintedLayer& layer : context.layers) layer.texels = {};
    if (context.streaming)
        for (PaintedLayer* layer : context.streaming->layersAway()) layer->texels = {};
    context.strokes.forEach([](uint32_t, PaintStroke& stroke) {
        for (PaintStroke::Part& part : stroke.parts) part.record.letGo();
    });
    context.grammars.forEach([](uint32_t, LoadedGrammar& grammar) {
        grammar.words = {};
        grammar.uploaded = 0;
    });
    context.variants.clear();
    context.seeds.forEach([](uint32_t, PlantedSeed& seed) { seed.variant = kNoIndex; });
    context.surfaceTable = {};
    context.layerTable = {};
    context.patterns.ground.clear();
    context.patterns.view = {};
    context.patterns.growth.reset();
    context.painter.reset();
    context.roofs.reset();
    context.renderer.reset();
    context.growth.reset();
}

// Nothing has grown, and nothing is drawn.
void forgetGrowth(EspContext& context) {
    context.plants.reset();
    context.parts = {};
    context.dropTriangles();
    context.grownGrammars.clear();
    context.grownSeeds.clear();
    context.grownSurfaces.clear();
    context.plantsRevision = 0;
    context.pairs.clear();
    context.touched.clear();
    context.surfaceChanges.clear();
    context.failed.forget();
    context.patterns.grownFrom = 0;
    context.patterns.failed.forget();
    context.roofBounds.clear();
    if (context.town) {
        context.town->view = {};
        context.town->failed.forget();
        context.town->whole = context.nodes.town.change();
    }
    context.nodes.surfaces.change();
    context.nodes.layers.change();
    context.nodes.seeds.change();
    context.changeWholly(context.nodes.limits);
    context.hasPicture = false;
    context.preparedFrame = 0;
}

// A streamed surface whose file can't be read any more is away; any other has to come back.
EspResult restoreSurfaces(EspContext& context) {
    std::vector<uint32_t> ids;
    context.surfaces.forEach([&](uint32_t id, const PlacedSurface&) { ids.push_back(id); });
    for (const uint32_t id : ids) {
        const EspResult bad = standAgain(context, id);
        const bool ofFile = bad == ESP_IO_FAILED || bad == ESP_INVALID_CONTENT;
        if (ofFile && context.streaming && context.streaming->knows(id))
            context.streaming->loseFile(id, bad, std::exchange(context.error, {}));
        else if (bad != ESP_OK)
            return bad;
    }
    return ESP_OK;
}

EspResult recreate(EspContext& context, const EspHostDevice* host) {
    if (!context.device->lost() && !context.bare)
        if (Status done = finishFrames(*context.device, "recreate"); !done && !context.device->lost())
            return failGpu(&context, done.failure());
    DeviceParts parts;
    std::string why;
    if (EspResult bad = makeDeviceParts(context, host, parts, why)) return fail(&context, bad, why);
    Evaluations evaluations;
    if (EspResult bad = evaluationsOn(context, *parts.device, evaluations)) return bad;
    context.bare = true;  // until all is there
    letGoOfDevice(context);
    for (auto& [id, evaluation] : evaluations) evaluateBy(*context.graphs.graphs.find(id), std::move(evaluation));
    context.graphs.changed = true;
    context.device = std::move(parts.device);
    context.renderer = std::move(parts.renderer);
    context.growth = std::move(parts.growth);
    forgetGrowth(context);
    for (const auto restore : {drawLooksAgain, furnishAgain, readPiecesAgain, restoreSurfaces, restorePaint})
        if (EspResult bad = restore(context)) return bad;
    context.bare = false;
    return ESP_OK;
}

}  // namespace
}  // namespace espalier

using namespace espalier;

extern "C" {

EspResult espRecreate(EspContext* context, const EspHostDevice* given) {
    return guarded(
        context,
        [&] {
            const EspHostDevice host = takenOr("espRecreate", given, EspHostDevice{});
            if (given)
                if (const char* mistake = espalier::mistakeIn(host))
                    throw Refusal{std::string("espRecreate: ") + mistake};
            return recreate(*context, given ? &host : nullptr);
        },
        true);
}

}  // extern "C"
