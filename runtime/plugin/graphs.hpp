#pragma once

#include <memory>
#include <string>

#include "plugin_api/espalier.h"
#include "runtime/plugin/graph_stands.hpp"
#include "runtime/plugin/id_table.hpp"

struct EspContext;

namespace espalier {

struct LoadedGraph {
    std::unique_ptr<NodeEvaluation> evaluation;
    bool measured = false;  // its nodes' times are
    GraphStands stands;
    std::string text, failures, note;  // that a host was handed
    std::string told;                  // failures and notes that were logged
    uint32_t evaluations = 0;
    Geometry shown;  // by the last evaluation, and boxes around its parts
    std::vector<NodeBox> boxes;
    Version made = 0;    // NodeEvaluation::revision() of the last evaluation
    Version shows = 0;   // NodeEvaluation::shownRevision() of that
    Version placed = 0;  // differs whenever `shown` does
};

// Procedural graphs of a context.
struct ContextGraphs {
    explicit ContextGraphs(uint32_t context) : graphs(context) {}
    IdTable<LoadedGraph, 8> graphs;
    bool changed = false;              // which there are
    std::vector<glm::vec3> positions;  // of the last espReadGraphPart
    std::vector<uint32_t> indices;
};

// An evaluation on a device, without a graph.
std::unique_ptr<NodeEvaluation> evaluationOn(EspContext& context, Device& device);
// What a graph's evaluation is, on another device, where nothing is made yet.
Result<std::unique_ptr<NodeEvaluation>> sameOn(EspContext& context, const LoadedGraph& graph, Device& device);
// Puts it in place of the graph's own, whose device is about to go, and whose meshes have been let go of.
void evaluateBy(LoadedGraph& graph, std::unique_ptr<NodeEvaluation> evaluation) noexcept;
// Makes what graphs show, hands meshes to the renderer if they have changed, and lets surfaces and plants stand.
EspResult updateGraphs(EspContext& context);
// Of nodes, and of what they ask for in vain.
std::vector<Diagnostic> failuresOf(const LoadedGraph& graph);

}  // namespace espalier
