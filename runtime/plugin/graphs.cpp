// In: graphs that have changed. Out: what they show, in the renderer's hands.
#include "runtime/plugin/graphs.hpp"

#include "runtime/plugin/context.hpp"
#include "runtime/plugin/errors.hpp"

namespace espalier {
namespace {

Result<NodeFile> readBeside(const Files& files, const std::string& graph, const std::string& name) {
    const Result<std::filesystem::path> place = files.beside(graph, name);
    if (!place) return place.failure();
    Result<std::vector<std::byte>> bytes = files.read(place.value().string());
    if (!bytes) return bytes.failure();
    return NodeFile{place.value().string(), std::move(*bytes)};
}

// Failures and notes that are new.
void tellFailures(EspContext& context, LoadedGraph& graph) {
    std::vector<Diagnostic> all = failuresOf(graph);
    for (Diagnostic note : graph.evaluation->notes()) {
        note.warning = false;  // the log says that it is one
        all.push_back(std::move(note));
    }
    const std::string now = all.empty() ? std::string() : toString(all);
    if (now != graph.told && !now.empty()) context.log(Severity::warning, now);
    graph.told = now;
}

Status evaluate(EspContext& context, LoadedGraph& graph) {
    if (graph.evaluation->due()) {
        if (Status made = graph.evaluation->evaluate(); !made) return made;
    }
    if (graph.made != graph.evaluation->revision()) ++graph.evaluations;
    graph.made = graph.evaluation->revision();
    if (graph.shows == graph.evaluation->shownRevision() && !graph.stands.due(context)) return Done{};
    graph.stands.update(context, *graph.evaluation);
    if (graph.stands.due(context)) graph.stands.update(context, *graph.evaluation);
    tellFailures(context, graph);
    Geometry shown = graph.evaluation->shown();
    shown.insert(shown.end(), graph.stands.waiting().begin(), graph.stands.waiting().end());
    Result<std::vector<NodeBox>> boxes = graph.evaluation->measure(shown);
    if (!boxes) return boxes.failure();
    graph.shown = std::move(shown);
    graph.boxes = std::move(*boxes);
    graph.shows = graph.evaluation->shownRevision();
    graph.placed = nextVersion();
    return Done{};
}

}  // namespace

std::vector<Diagnostic> failuresOf(const LoadedGraph& graph) {
    std::vector<Diagnostic> all = graph.evaluation->failures();
    const NodeGraph& text = graph.evaluation->graph();
    for (const GraphTrouble& trouble : graph.stands.troubles()) {
        const int node = text.find(trouble.node);
        const TextPlace place = node < 0 ? TextPlace() : text.nodes[size_t(node)].place;
        all.push_back({text.file, place.line, place.column, trouble.node, trouble.why, false});
    }
    return all;
}

std::unique_ptr<NodeEvaluation> evaluationOn(EspContext& context, Device& device) {
    return std::make_unique<NodeEvaluation>(deviceMachine(device, !context.grow.shadersOnly),
                                            [&context](const std::string& graph, const std::string& name) {
                                                return readBeside(context.files, graph, name);
                                            });
}

Result<std::unique_ptr<NodeEvaluation>> sameOn(EspContext& context, const LoadedGraph& graph, Device& device) {
    std::unique_ptr<NodeEvaluation> evaluation = evaluationOn(context, device);
    // Unfinished as it may be: it was taken before.
    Status loaded = evaluation->load(NodeGraph(graph.evaluation->graph()), true);
    if (!loaded) return loaded.failure();
    evaluation->setTime(graph.evaluation->time());
    evaluation->measureTimes(graph.measured);
    return evaluation;
}

void evaluateBy(LoadedGraph& graph, std::unique_ptr<NodeEvaluation> evaluation) noexcept {
    graph.shown.clear();
    graph.boxes.clear();
    graph.made = graph.shows = 0;
    graph.evaluation = std::move(evaluation);
}

EspResult updateGraphs(EspContext& context) {
    ContextGraphs& all = context.graphs;
    if (all.graphs.size() == 0 && !all.changed) return ESP_OK;
    bool changed = all.changed;
    Status made = Done{};
    all.graphs.forEach([&](uint32_t, LoadedGraph& graph) {
        const Version before = graph.placed;
        if (made) made = evaluate(context, graph);
        changed = changed || graph.placed != before;
    });
    if (!made) return failWork(&context, made.failure());
    if (!changed) return ESP_OK;
    Geometry parts;
    std::vector<NodeBox> boxes;
    all.graphs.forEach([&](uint32_t, LoadedGraph& graph) {
        parts.insert(parts.end(), graph.shown.begin(), graph.shown.end());
        boxes.insert(boxes.end(), graph.boxes.begin(), graph.boxes.end());
    });
    all.changed = true;  // until it is placed
    if (Status placed = context.renderer->placeGraph(std::move(parts), boxes); !placed)
        return failGpu(&context, placed.failure());
    all.changed = false;
    return ESP_OK;
}

}  // namespace espalier
