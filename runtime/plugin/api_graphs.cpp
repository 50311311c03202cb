// Procedural graphs: their texts, inputs, time, and what their nodes make.
#include <cmath>

#include "runtime/plugin/context.hpp"
#include "runtime/plugin/errors.hpp"
#include "runtime/plugin/given.hpp"

namespace espalier {
namespace {

constexpr size_t kMostGraphBytes = 16u << 20;

LoadedGraph* find(const EspContext* context, EspGraph graph) {
    return context ? const_cast<EspContext*>(context)->graphs.graphs.find(graph.id) : nullptr;
}

EspResult load(const EspContext* context, const char* call, const EspGraphDef& def, NodeEvaluation& into) {
    const std::string name = def.name ? def.name : "graph";
    if (!def.text && def.length) return fail(context, ESP_INVALID_ARGUMENT, std::string(call) + ": its text is null");
    if (def.length > kMostGraphBytes)
        return fail(context, ESP_INVALID_CONTENT, name + ": the text is longer than 16 MiB");
    Result<NodeGraph> graph = parseGraph({def.text, def.length}, name);
    if (!graph) return failContent(context, graph.failure());
    if (Status loaded = into.load(std::move(*graph), def.unfinished != 0); !loaded)
        return failContent(context, loaded.failure());
    return ESP_OK;
}

// moved: places as the part's modifiers leave them.
EspResult readPart(EspContext& context, NodeEvaluation& evaluation, const GeometryPart& part, bool moved,
                   EspGraphPart& out) {
    ContextGraphs& graphs = context.graphs;
    if (Status read = assign(graphs.positions, moved ? evaluation.places(part) : evaluation.positions(part)); !read)
        return moved && !read.failure().ofDevice() ? failContent(&context, read.failure())
                                                   : failGpu(&context, read.failure());
    if (Status read = assign(graphs.indices, evaluation.corners(part)); !read) return failGpu(&context, read.failure());
    out.kind = EspGraphPartKind(part.kind);
    out.positionCount = part.elements;
    out.curves = part.kind == GeometryPart::Kind::curves ? part.used : 0;
    out.samples = part.samples;
    out.indexCount = part.indexCount;
    out.instanceCount = part.instances();
    out.positions = graphs.positions.empty() ? nullptr : &graphs.positions.front().x;
    out.indices = graphs.indices.data();
    return ESP_OK;
}

EspResult readPartOf(const char* call, EspContext* context, EspGraph id, const char* node, const char* output,
                     uint32_t number, bool moved, EspGraphPart* out) {
    return guarded(context, [&] {
        LoadedGraph* graph = find(context, id);
        if (!graph || !node)
            return fail(context, ESP_INVALID_ARGUMENT, std::string(call) + ": no such graph, or no node");
        Result<const NodeValue*> value = graph->evaluation->inspect(node, output ? output : "");
        if (!value) return failGpu(context, value.failure());
        const Geometry* parts = *value ? std::get_if<Geometry>(*value) : nullptr;
        if (!parts || number >= parts->size())
            return fail(context, ESP_INVALID_ARGUMENT, std::string(call) + ": '" + node + "' has no such geometry");
        EspGraphPart part{};
        part.partCount = uint32_t(parts->size());
        if (EspResult bad = readPart(*context, *graph->evaluation, (*parts)[number], moved, part)) return bad;
        give(call, out, part);
        return ESP_OK;
    });
}

}  // namespace
}  // namespace espalier

using namespace espalier;

extern "C" {

EspResult espCompileGraph(EspContext* context, const EspGraphDef* given, EspGraph* out) {
    return guarded(context, [&] {
        const EspGraphDef def = taken("espCompileGraph", given);
        if (!out) return fail(context, ESP_INVALID_ARGUMENT, "espCompileGraph: null pointer");
        LoadedGraph graph;
        graph.evaluation = evaluationOn(*context, *context->device);
        if (EspResult bad = load(context, "espCompileGraph", def, *graph.evaluation)) return bad;
        const uint32_t id = context->graphs.graphs.insert(std::move(graph));
        if (!id) return fail(context, ESP_INVALID_ARGUMENT, "espCompileGraph: there are 255 graphs already");
        context->graphs.changed = true;
        out->id = id;
        return ESP_OK;
    });
}

EspResult espRecompileGraph(EspContext* context, EspGraph id, const EspGraphDef* given) {
    return guarded(context, [&] {
        const EspGraphDef def = taken("espRecompileGraph", given);
        LoadedGraph* graph = find(context, id);
        if (!graph) return fail(context, ESP_INVALID_ARGUMENT, "espRecompileGraph: no such graph");
        return load(context, "espRecompileGraph", def, *graph->evaluation);
    });
}

EspResult espDestroyGraph(EspContext* context, EspGraph id) {
    return guarded(context, [&] {
        LoadedGraph* graph = find(context, id);
        if (!graph) return fail(context, ESP_INVALID_ARGUMENT, "espDestroyGraph: no such graph");
        graph->stands.removeAll(*context);
        context->graphs.graphs.erase(id.id);
        context->graphs.changed = true;
        return ESP_OK;
    });
}

EspResult espSetGraphTime(EspContext* context, EspGraph id, double frame, double step) {
    return guarded(context, [&] {
        LoadedGraph* graph = find(context, id);
        if (!graph) return fail(context, ESP_INVALID_ARGUMENT, "espSetGraphTime: no such graph");
        if (!(frame >= 0 && frame <= 16777216 && frame == std::floor(frame)) || !(step > 0 && step <= 3600))
            return fail(context, ESP_INVALID_ARGUMENT, "espSetGraphTime: frame or step is out of its range");
        graph->evaluation->setTime({frame, step});
        return ESP_OK;
    });
}

EspResult espSetGraphInput(EspContext* context, EspGraph id, const EspGraphInput* given) {
    return guarded(context, [&] {
        const EspGraphInput input = taken("espSetGraphInput", given);
        LoadedGraph* graph = find(context, id);
        if (!graph || !input.node || !input.input || !isAmong(input.kind, ESP_GRAPH_NUMBER, ESP_GRAPH_TEXT) ||
            (input.kind == ESP_GRAPH_TEXT && !input.text))
            return fail(context, ESP_INVALID_ARGUMENT, "espSetGraphInput: no such graph, or an argument is missing");
        Literal value(vec(input.numbers));
        if (input.kind == ESP_GRAPH_NUMBER) value = Literal(input.numbers[0]);
        if (input.kind == ESP_GRAPH_TEXT) value = Literal(input.text);
        const Status set = graph->evaluation->setInput(input.node, input.input, value);
        return set ? ESP_OK : failContent(context, set.failure());
    });
}

EspResult espNextGraphBake(EspContext* context, EspGraph id, EspGraphBake* out) {
    return guarded(context, [&] {
        const LoadedGraph* graph = find(context, id);
        if (!graph) return fail(context, ESP_INVALID_ARGUMENT, "espNextGraphBake: no such graph");
        EspGraphBake bake{};
        if (const GroundWish* wish = graph->stands.wanted()) {
            bake.key = wish->key;
            bake.resolution = wish->resolution;
            bake.positions = &wish->places.front().x;
            bake.positionCount = uint32_t(wish->places.size());
            bake.indices = wish->corners.data();
            bake.indexCount = wish->corners.size();
            put(bake.colour, wish->material.colour);
            bake.roughness = wish->material.roughness;
        }
        give("espNextGraphBake", out, bake);
        return ESP_OK;
    });
}

EspResult espGiveGraphBake(EspContext* context, EspGraph id, uint64_t key, const char* path, const char* why) {
    return guarded(context, [&] {
        LoadedGraph* graph = find(context, id);
        if (!graph || (!path && !why))
            return fail(context, ESP_INVALID_ARGUMENT,
                        "espGiveGraphBake: no such graph, or neither a path nor a reason");
        return graph->stands.give(*context, key, path ? path : "", path ? "" : why);
    });
}

const char* espGraphText(EspContext* context, EspGraph id) {
    LoadedGraph* graph = find(context, id);
    if (!graph) return "";
    const EspResult made = guarded(context, [&] {
        graph->text = printGraph(graph->evaluation->graph());
        return ESP_OK;
    });
    return made == ESP_OK ? graph->text.c_str() : "";
}

const char* espGraphFailures(EspContext* context, EspGraph id) {
    LoadedGraph* graph = find(context, id);
    if (!graph) return "";
    const EspResult made = guarded(context, [&] {
        const std::vector<Diagnostic> failures = failuresOf(*graph);
        graph->failures = failures.empty() ? std::string() : toString(failures);
        return ESP_OK;
    });
    return made == ESP_OK ? graph->failures.c_str() : "";
}

EspResult espGraphStats(EspContext* context, EspGraph id, EspGraphStats* out) {
    return guarded(context, [&] {
        const LoadedGraph* graph = find(context, id);
        if (!graph) return fail(context, ESP_INVALID_ARGUMENT, "espGraphStats: no such graph");
        const NodeEvaluation::Stats& s = graph->evaluation->stats();
        EspGraphStats stats{};
        stats.nodes = uint32_t(graph->evaluation->graph().nodes.size());
        stats.evaluated = s.evaluated;
        stats.evaluations = graph->evaluations;
        stats.parts = uint32_t(graph->shown.size());
        stats.dispatches = s.dispatches;
        glm::vec3 low(1e30f), high(-1e30f);
        for (size_t i = 0; i < graph->shown.size(); ++i) {
            const GeometryPart& part = graph->shown[i];
            if (part.kind != GeometryPart::Kind::mesh) continue;
            low = glm::min(low, graph->boxes[i].low);
            high = glm::max(high, graph->boxes[i].high);
            stats.vertices += part.elements;
            stats.triangles += part.indexCount / 3;
            stats.instances += part.instances();
        }
        stats.ms = s.ms;
        if (low.x <= high.x) {
            put(stats.boundsMin, low);
            put(stats.boundsMax, high);
        }
        give("espGraphStats", out, stats);
        return ESP_OK;
    });
}

EspResult espReadGraphPart(EspContext* context, EspGraph id, const char* node, const char* output, uint32_t number,
                           EspGraphPart* out) {
    return readPartOf("espReadGraphPart", context, id, node, output, number, false, out);
}

EspResult espReadGraphPlaces(EspContext* context, EspGraph id, const char* node, const char* output, uint32_t number,
                             EspGraphPart* out) {
    return readPartOf("espReadGraphPlaces", context, id, node, output, number, true, out);
}

}  // extern "C"
