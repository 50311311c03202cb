// Files and texts of procedural graphs -> graphs in a context; a graph on its own becomes a scene.
#include "plugin_api/espalier.hpp"
#include "tools/scene/scene_parts.hpp"
#include "tools/scene/text_file.hpp"

namespace espalier::scene {
namespace {

EspGraphDef defOf(const LoadedGraph& graph, const std::string& text) {
    EspGraphDef def{};
    def.unfinished = 1;  // who edits wires nodes one after the other
    def.name = graph.file.c_str();
    def.text = text.data();
    def.length = text.size();
    return def;
}

}  // namespace

bool compileGraph(EspContext* context, const Scene& scene, LoadedGraph& graph, std::string& error) {
    const EspGraphDef def = defOf(graph, graph.text);
    if (!fromContext(context, espCompileGraph(context, &def, &graph.id), error)) return false;
    graph.runs = graph.text;
    return fromContext(context, espSetGraphTime(context, graph.id, scene.graphFrame, 1.0 / double(scene.graphRate)),
                       error);
}

bool setText(EspContext* context, LoadedGraph& graph, const std::string& text) {
    graph.text = text;
    graph.error.clear();
    const EspGraphDef def = defOf(graph, text);
    if (!fromContext(context, espRecompileGraph(context, graph.id, &def), graph.error)) return false;
    graph.runs = text;
    return true;
}

bool loadGraphs(EspContext* context, const std::vector<SceneGraph>& graphs, Scene& out, std::string& error) {
    for (const SceneGraph& described : graphs) {
        LoadedGraph graph{described.file, {}, {}, {}, {}};
        if (described.text)
            graph.text = described.runs.value_or(*described.text);
        else if (!readText(described.file, graph.text, error))
            return false;
        if (!compileGraph(context, out, graph, error)) return false;
        if (described.runs) (void)setText(context, graph, *described.text);
        out.graphs.push_back(graph);
    }
    // What they show is in the view that shows all.
    return graphs.empty() || fromContext(context, espUpdate(context), error);
}

bool openGraph(EspContext* context, const Request& request, Scene& out, std::string& error) {
    if (!loadGraphs(context, {{request.file}}, out, error)) return false;
    out.camera = esp::frameAll(context);
    EspGraphStats stats;
    if (!fromContext(context, espGraphStats(context, out.graphs.front().id, &stats), error)) return false;
    layGround(stats.boundsMin[1], out);
    return true;
}

bool setGraphTime(EspContext* context, Scene& scene, uint32_t frame, float rate, std::string& error) {
    for (const LoadedGraph& graph : scene.graphs)
        if (!fromContext(context, espSetGraphTime(context, graph.id, frame, 1.0 / double(rate)), error)) return false;
    scene.graphFrame = frame;
    scene.graphRate = rate;
    return true;
}

}  // namespace espalier::scene
