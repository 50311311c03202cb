#pragma once

// A graph that runs: values of its nodes, and what has to be made again. Invalidation is pushed over the graph when an
// input changes; values are pulled from what is shown. A node that fails says why; it and what depends on it keep their
// last good outputs, and all others go on.

#include <map>
#include <memory>
#include <optional>

#include "runtime/graph/node.hpp"
#include "runtime/nodes/measure.hpp"
#include "runtime/nodes/node_work.hpp"
#include "runtime/nodes/read_back.hpp"

namespace espalier {

class NodeEvaluation {
  public:
    // files: reads what nodes name; none: there are no files.
    explicit NodeEvaluation(std::unique_ptr<NodeMachine> machine, NodeFiles files = {});
    NodeEvaluation(NodeEvaluation&&) = default;
    NodeEvaluation& operator=(NodeEvaluation&&) = delete;
    ~NodeEvaluation();

    // In place of the graph before. Nodes of the same name that are made from the same as before keep their values. On
    // failure the graph before stays.
    Status load(NodeGraph graph, bool unfinished = false);  // unfinished: see checkGraph
    const NodeGraph& graph() const { return graph_; }
    const std::vector<Diagnostic>& warnings() const { return checked_.warnings; }

    // Another constant at a node's input, as if the text said so. Fails where the text would.
    Status setInput(std::string_view node, std::string_view port, const Literal& value);
    void setTime(const GraphTime& time);
    const GraphTime& time() const { return time_; }

    // Makes what is shown and due. Fails when the device does; then all is due again. A node's own failure is no
    // failure of the call: see failures().
    Status evaluate();
    bool due() const;

    // Of what is shown, by the last evaluation: geometry of all shown nodes.
    Geometry shown() const;
    // What each shown node gives, by its first output, in the order of the text; null: it was never made.
    struct Shown {
        uint32_t node = 0;  // in graph().nodes
        const NodeValue* value = nullptr;
    };
    std::vector<Shown> shownValues() const;
    // A node's output, made if it is due; null: there is no such node or output, or it has none.
    Result<const NodeValue*> inspect(std::string_view node, std::string_view output = "");
    // How a node stands by the last evaluation; nothing is made for it.
    struct NodeState {
        const NodeValue* value = nullptr;  // of its first output; null: it was never made
        const std::string* failure = nullptr;
        const std::string* note = nullptr;  // what it says of itself though it could be made
        bool blocked = false;               // something that it reads has failed
        uint32_t evaluations = 0;           // that there were
        std::optional<double> ms{};         // of the last one; none: it wasn't measured
    };
    std::optional<NodeState> state(std::string_view node, size_t output = 0) const;  // none: there is no such node
    // Each node is run by itself from now on, so that its time is known.
    void measureTimes(bool on) { timed_ = on; }
    Result<std::vector<NodeBox>> measure(const Geometry& parts) { return espalier::measure(*machine_, parts); }
    // Of a part without its padding: places before its program, octahedral normals, corners of triangles.
    Result<std::vector<glm::vec3>> positions(const GeometryPart& part) { return readPlaces(*machine_, part); }
    Result<std::vector<uint32_t>> normals(const GeometryPart& part) { return readWords(*machine_, part, part.normals); }
    Result<std::vector<uint32_t>> corners(const GeometryPart& part) { return readCorners(*machine_, part); }
    // Places as its program leaves them; fails for what is scattered.
    Result<std::vector<glm::vec3>> places(const GeometryPart& part);
    std::vector<Diagnostic> failures() const;
    std::vector<Diagnostic> notes() const;
    // Differs whenever an evaluation has made something.
    Version revision() const { return revision_; }
    // Differs also when other nodes are shown.
    Version shownRevision() const { return shownRevision_; }

    struct Stats {
        uint32_t nodes = 0, evaluated = 0, kernels = 0, dispatches = 0;  // of the last evaluation that made something
        double ms = 0;
    };
    const Stats& stats() const { return stats_; }

  private:
    struct Pass;
    struct Made {
        std::vector<NodeValue> outputs;  // empty: never made
        NodeKept kept;
        std::vector<Pass> passes;   // of what it repeats
        std::string failure, note;  // why it couldn't be made; "": it could
        bool blocked = false;       // something that it reads has failed
    };
    // What a loop's nodes have made in one pass, and from what.
    struct Pass {
        std::vector<Made> nodes;  // [place in the loop's body]
        LoopPass given;
        Version madeFrom = 0;  // 0: it has to be made anew
    };
    // The passes that are being made, the innermost first.
    struct Scope {
        const Scope* outer = nullptr;
        const CheckedGraph::Loop* loop = nullptr;
        const LoopPass* given = nullptr;
        std::vector<Made>* nodes = nullptr;
        uint64_t passes = 1;  // of all scopes together
        uint32_t depth = 1;
    };
    struct Running : Made {
        std::unique_ptr<graph::Node> version;
        uint32_t evaluations = 0;
        std::optional<double> ms;
    };
    using Names = std::map<std::string, uint32_t, std::less<>>;
    std::vector<uint32_t> pulledBy(std::vector<uint32_t> roots) const;
    Status make(const std::vector<uint32_t>& pulled);
    Status makeNode(uint32_t n, NodeWorkList& list) { return makeIn(nullptr, n, running_[n], list); }
    Status makeIn(const Scope* scope, uint32_t n, Made& made, NodeWorkList& list);
    const Made& madeIn(const Scope* scope, uint32_t n) const;
    Result<const NodeValue*> makePass(const Scope* outer, uint32_t n, Made& made, const LoopPass& given,
                                      NodeWorkList& list);
    Status makeBody(const Scope& scope, NodeWorkList& list);
    bool sameLoop(const NodeGraph& graph, const CheckedGraph& checked, uint32_t now, uint32_t before) const;
    Status makeTimed(uint32_t n, NodeWorkList& list, Stats& measured);
    Status forget(const std::vector<uint32_t>& due, Status failed);
    std::vector<bool> unchanged(const NodeGraph& graph, const CheckedGraph& checked) const;
    void dropVersions();
    int find(std::string_view node) const;

    std::unique_ptr<NodeMachine> machine_;
    NodeFiles files_;
    NodeGraph graph_;
    CheckedGraph checked_;
    Names names_;
    std::vector<Running> running_;  // [node]
    std::vector<uint32_t> pulled_;  // by what is shown, in order
    std::unique_ptr<graph::Node> shownVersion_;
    GraphTime time_;
    bool timed_ = false;
    Stats stats_;
    Version revision_ = 0, shownRevision_ = 0;
};

}  // namespace espalier
