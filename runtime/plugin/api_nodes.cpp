// The table of node kinds, texts as nodes, and how nodes stand: what editors of graphs ask for.
#include "runtime/plugin/context.hpp"
#include "runtime/plugin/errors.hpp"
#include "runtime/plugin/given.hpp"
#include "runtime/plugin/graphs.hpp"

// What a text holds, with the texts that hosts are handed.
struct EspGraphNodes {
    espalier::NodeGraph graph;
    std::vector<std::string> comments;  // [node]
    std::string remarks;
    struct Listed {
        uint32_t placed = 0, shown = 0, muted = 0;
        glm::vec3 place{0};
    };
    std::vector<Listed> listed;  // [node]
};

namespace espalier {
namespace {

const NodeKind& kindAt(const char* call, uint32_t kind) {
    if (kind >= nodeKinds().size()) throw Refusal{std::string(call) + ": there is no such kind of node"};
    return nodeKinds()[kind];
}

EspNodePort infoOf(const NodePort& port) {
    EspNodePort info{};
    info.type = EspNodeType(port.type);
    info.wired = port.standard.kind == Literal::Kind::none && !port.optional;
    info.many = port.many;
    info.words = uint32_t(port.words.size());
    put(info.standard, port.standard.numbers);
    info.low = port.low;
    info.high = port.high;
    info.name = port.name.c_str();
    info.unit = port.unit;
    info.help = port.help;
    info.text = port.standard.kind == Literal::Kind::text ? port.standard.text.c_str() : nullptr;
    info.opener = *port.opener ? port.opener : nullptr;
    return info;
}

std::string joined(const std::vector<std::string>& lines) {
    std::string out;
    for (size_t i = 0; i < lines.size(); ++i) out += (i ? "\n" : "") + lines[i];
    return out;
}

// The numbers that nodes have in the text's lists.
void number(EspGraphNodes& nodes) {
    std::unordered_map<std::string_view, uint32_t> named;
    for (uint32_t n = 0; n < nodes.graph.nodes.size(); ++n) named.emplace(nodes.graph.nodes[n].name, n);
    const auto list = [&](const auto& entries, const auto& note) {
        for (uint32_t i = 0; i < entries.size(); ++i)
            if (const auto found = named.find(entries[i].first); found != named.end())
                note(nodes.listed[found->second], entries[i], i + 1);
    };
    using Listed = EspGraphNodes::Listed;
    list(nodes.graph.shown, [](Listed& listed, const auto&, uint32_t i) { listed.shown = i; });
    list(nodes.graph.muted, [](Listed& listed, const auto&, uint32_t i) { listed.muted = i; });
    list(nodes.graph.layout, [](Listed& listed, const auto& entry, uint32_t i) {
        listed.placed = i;
        listed.place = entry.second;
    });
}

const GraphNode& nodeAt(const char* call, const EspGraphNodes* nodes, uint32_t node) {
    if (!nodes || node >= nodes->graph.nodes.size()) throw Refusal{std::string(call) + ": there is no such node"};
    return nodes->graph.nodes[node];
}

void count(const Geometry& parts, EspNodeState& state) {
    state.parts = uint32_t(parts.size());
    for (const GeometryPart& part : parts) {
        const EspNodeType type = EspNodeType(int(ESP_NODE_POINTS) + int(part.kind));
        state.type = &part == &parts.front() || state.type == type ? type : ESP_NODE_GEOMETRY;
        if (part.kind == GeometryPart::Kind::points) state.points += part.elements;
        if (part.kind == GeometryPart::Kind::curves) state.curves += part.used;
        if (part.kind == GeometryPart::Kind::mesh) {
            state.vertices += part.elements;
            state.triangles += part.indexCount / 3;
        }
        state.instances += part.instances();
    }
}

// What a node asks of other stages.
void describeWish(const NodeValue& value, EspNodeState& state) {
    if (std::holds_alternative<RulesRef>(value)) state.type = ESP_NODE_GRAMMAR;
    if (std::holds_alternative<TownRef>(value)) state.type = ESP_NODE_TOWN;
    if (std::holds_alternative<CoverRef>(value)) state.type = ESP_NODE_LAYER;
    if (const auto* ground = std::get_if<GroundRef>(&value)) {
        state.type = ESP_NODE_SURFACE;
        state.vertices = (*ground)->places.size();
        state.triangles = (*ground)->corners.size() / 3;
    }
    if (const auto* plants = std::get_if<PlantsRef>(&value)) {
        state.type = ESP_NODE_PLANTS;
        state.points = (*plants)->points.size();
    }
}

void describe(const NodeValue& value, EspNodeState& state) {
    if (const auto* number = std::get_if<float>(&value)) {
        state.type = ESP_NODE_NUMBER;
        state.numbers[0] = *number;
    } else if (const auto* vector = std::get_if<glm::vec3>(&value)) {
        state.type = ESP_NODE_VECTOR;
        put(state.numbers, *vector);
    } else if (const auto* look = std::get_if<MaterialLook>(&value)) {
        state.type = ESP_NODE_MATERIAL;
        put(state.numbers, look->colour);
    } else if (const auto* parts = std::get_if<Geometry>(&value)) {
        state.type = ESP_NODE_GEOMETRY;
        count(*parts, state);
    } else {
        describeWish(value, state);
    }
}

// Which of a node's outputs is meant; nothing: there is none of that name.
std::optional<size_t> outputOf(const NodeGraph& graph, const char* node, const char* output) {
    if (!output || !*output) return 0;
    const int n = graph.find(node);
    const NodeKind* kind = n < 0 ? nullptr : findNodeKind(graph.nodes[size_t(n)].kind);
    const int at = kind ? kind->output(output) : -1;
    return at < 0 ? std::nullopt : std::optional(size_t(at));
}

}  // namespace
}  // namespace espalier

using namespace espalier;

extern "C" {

uint32_t espNodeKindCount(void) {
    return uint32_t(nodeKinds().size());
}

EspResult espNodeKindInfo(uint32_t kind, EspNodeKind* out) {
    return guardedAlone([&] {
        const NodeKind& row = kindAt("espNodeKindInfo", kind);
        EspNodeKind info{};
        info.inputs = uint32_t(row.inputs.size());
        info.outputs = uint32_t(row.outputs.size());
        info.name = row.name.c_str();
        info.help = row.help;
        info.group = row.group;
        give("espNodeKindInfo", out, info);
        return ESP_OK;
    });
}

EspResult espNodeInput(uint32_t kind, uint32_t input, EspNodePort* out) {
    return guardedAlone([&] {
        const NodeKind& row = kindAt("espNodeInput", kind);
        if (input >= row.inputs.size()) throw Refusal{"espNodeInput: there is no such input"};
        give("espNodeInput", out, infoOf(row.inputs[input]));
        return ESP_OK;
    });
}

EspResult espNodeOutput(uint32_t kind, uint32_t output, EspNodePort* out) {
    return guardedAlone([&] {
        const NodeKind& row = kindAt("espNodeOutput", kind);
        if (output >= row.outputs.size()) throw Refusal{"espNodeOutput: there is no such output"};
        EspNodePort info{};
        info.type = EspNodeType(row.outputs[output].type);
        info.asFirst = row.outputs[output].asInput;
        info.name = row.outputs[output].name.c_str();
        info.unit = info.help = "";
        give("espNodeOutput", out, info);
        return ESP_OK;
    });
}

const char* espNodeWord(uint32_t kind, uint32_t input, uint32_t word) {
    const auto kinds = nodeKinds();
    if (kind >= kinds.size() || input >= kinds[kind].inputs.size()) return nullptr;
    const std::vector<std::string>& words = kinds[kind].inputs[input].words;
    return word < words.size() ? words[word].c_str() : nullptr;
}

const char* espNodeTypeName(EspNodeType type) {
    return isAmong(type, ESP_NODE_NUMBER, ESP_NODE_GEOMETRY) ? nameOf(ValueType(type)) : "";
}

int espNodeTypeTakes(EspNodeType input, EspNodeType given) {
    return isAmong(input, ESP_NODE_NUMBER, ESP_NODE_GEOMETRY) && isAmong(given, ESP_NODE_NUMBER, ESP_NODE_GEOMETRY) &&
           accepts(ValueType(input), ValueType(given));
}

EspResult espReadGraphNodes(EspContext* context, const EspGraphDef* given, EspGraphNodes** out) {
    return guarded(context, [&] {
        const EspGraphDef def = taken("espReadGraphNodes", given);
        if (!out || (!def.text && def.length))
            return fail(context, ESP_INVALID_ARGUMENT, "espReadGraphNodes: null pointer");
        Result<NodeGraph> graph = parseGraph({def.text, def.length}, def.name ? def.name : "graph");
        if (!graph) return failContent(context, graph.failure());
        auto nodes = std::make_unique<EspGraphNodes>();
        nodes->graph = std::move(*graph);
        for (const GraphNode& node : nodes->graph.nodes) nodes->comments.push_back(joined(node.comments));
        nodes->remarks = joined(nodes->graph.comments);
        nodes->listed.resize(nodes->graph.nodes.size());
        number(*nodes);
        *out = nodes.release();
        return ESP_OK;
    });
}

void espFreeGraphNodes(EspGraphNodes* nodes) {
    delete nodes;
}

uint32_t espGraphNodeCount(const EspGraphNodes* nodes) {
    return nodes ? uint32_t(nodes->graph.nodes.size()) : 0;
}

EspResult espGraphNodeAt(const EspGraphNodes* nodes, uint32_t node, EspGraphNode* out) {
    return guardedAlone([&] {
        const GraphNode& from = nodeAt("espGraphNodeAt", nodes, node);
        const EspGraphNodes::Listed& listed = nodes->listed[node];
        EspGraphNode info{};
        info.inputs = uint32_t(from.inputs.size());
        info.line = uint32_t(from.place.line);
        info.column = uint32_t(from.place.column);
        info.place[0] = listed.place.x;
        info.place[1] = listed.place.y;
        info.placed = listed.placed;
        info.shown = listed.shown;
        info.muted = listed.muted;
        info.name = from.name.c_str();
        info.kind = from.kind.c_str();
        info.comments = from.comments.empty() ? nullptr : nodes->comments[node].c_str();
        give("espGraphNodeAt", out, info);
        return ESP_OK;
    });
}

EspResult espGraphNodeInput(const EspGraphNodes* nodes, uint32_t node, uint32_t input, EspGraphGiven* out) {
    return guardedAlone([&] {
        const GraphNode& of = nodeAt("espGraphNodeInput", nodes, node);
        if (input >= of.inputs.size()) throw Refusal{"espGraphNodeInput: there is no such input"};
        const NodeInput& from = of.inputs[input];
        const bool wire = from.constant.kind == Literal::Kind::none;
        EspGraphGiven info{};
        info.kind = wire ? ESP_GRAPH_WIRE : EspGraphValueKind(int(from.constant.kind) - int(Literal::Kind::number));
        info.input = from.port.c_str();
        info.text = from.constant.text.c_str();
        info.from = from.from.c_str();
        info.output = from.output.c_str();
        put(info.numbers, from.constant.numbers);
        give("espGraphNodeInput", out, info);
        return ESP_OK;
    });
}

const char* espGraphRemarks(const EspGraphNodes* nodes) {
    return nodes && !nodes->graph.comments.empty() ? nodes->remarks.c_str() : nullptr;
}

EspResult espNodeStateOf(EspContext* context, EspGraph id, const char* node, const char* output, EspNodeState* out) {
    return guarded(context, [&] {
        LoadedGraph* graph = context->graphs.graphs.find(id.id);
        if (!graph || !node) throw Refusal{"espNodeStateOf: no such graph, or no node"};
        const std::optional<size_t> at = outputOf(graph->evaluation->graph(), node, output);
        const auto state = at ? graph->evaluation->state(node, *at) : std::nullopt;
        if (!state) throw Refusal{std::string("espNodeStateOf: there is no '") + node + "', or no such output of it"};
        EspNodeState info{};
        info.made = state->value != nullptr;
        info.waits = state->blocked;
        info.evaluations = state->evaluations;
        info.ms = state->ms.value_or(-1);
        if (state->value) describe(*state->value, info);
        graph->failures = *state->failure;
        for (const GraphTrouble& trouble : graph->stands.troubles())
            if (trouble.node == node && graph->failures.empty()) graph->failures = trouble.why;
        info.failure = graph->failures.c_str();
        graph->note = *state->note;
        info.note = graph->note.c_str();
        give("espNodeStateOf", out, info);
        return ESP_OK;
    });
}

EspResult espMeasureGraph(EspContext* context, EspGraph id, int on) {
    return guarded(context, [&] {
        LoadedGraph* graph = context->graphs.graphs.find(id.id);
        if (!graph) throw Refusal{"espMeasureGraph: no such graph"};
        graph->measured = on != 0;
        graph->evaluation->measureTimes(graph->measured);
        return ESP_OK;
    });
}

}  // extern "C"
