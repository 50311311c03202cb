// In: a checked graph, changes of its inputs. Out: values of what is shown, each made once after each change.
#include "runtime/nodes/evaluation.hpp"

#include <algorithm>
#include <chrono>
#include <utility>

namespace espalier {

NodeEvaluation::NodeEvaluation(std::unique_ptr<NodeMachine> machine, NodeFiles files)
    : machine_(std::move(machine)), files_(std::move(files)) {}

NodeEvaluation::~NodeEvaluation() {
    dropVersions();
}

// Who reads goes before what it reads.
void NodeEvaluation::dropVersions() {
    shownVersion_.reset();
    for (size_t i = checked_.order.size(); i-- > 0;) running_[checked_.order[i]].version.reset();
}

int NodeEvaluation::find(std::string_view node) const {
    const auto found = names_.find(node);
    return found == names_.end() ? -1 : int(found->second);
}

// [node] of the new graph: it is made from the same as the node of its name in the old one.
std::vector<bool> NodeEvaluation::unchanged(const NodeGraph& graph, const CheckedGraph& checked) const {
    std::vector<bool> same(graph.nodes.size());
    for (const uint32_t n : checked.order) {
        const int before = find(graph.nodes[n].name);
        if (before < 0) continue;
        const CheckedGraph::Node &now = checked.nodes[n], &then = checked_.nodes[size_t(before)];
        if (now.kind != then.kind || now.constants != then.constants || now.wires.size() != then.wires.size() ||
            now.muted != then.muted || graph.file != graph_.file)
            continue;
        same[n] = std::ranges::equal(now.wires, then.wires, [&](const auto& a, const auto& b) {
            return a.port == b.port && a.output == b.output && same[a.node] &&
                   graph.nodes[a.node].name == graph_.nodes[b.node].name;
        });
    }
    return same;
}

Status NodeEvaluation::load(NodeGraph graph, bool unfinished) {
    Result<CheckedGraph> checked = checkGraph(graph, unfinished);
    if (!checked) return checked.failure();
    Names names;
    for (uint32_t n = 0; n < graph.nodes.size(); ++n) names.emplace(graph.nodes[n].name, n);
    const std::vector<bool> same = unchanged(graph, *checked);
    std::vector<Running> running(graph.nodes.size());
    for (const uint32_t n : checked->order) {
        std::vector<graph::Node*> inputs;
        for (const CheckedGraph::Wire& wire : checked->nodes[n].wires)
            inputs.push_back(running[wire.node].version.get());
        std::ranges::sort(inputs);
        inputs.erase(std::unique(inputs.begin(), inputs.end()), inputs.end());
        running[n].version = std::make_unique<graph::Node>(std::move(inputs));
        const int before = find(graph.nodes[n].name);
        if (before < 0 || checked->nodes[n].kind != checked_.nodes[size_t(before)].kind) continue;
        // Also a node that has changed shows what it made last until it can be made anew.
        Running& old = running_[size_t(before)];
        const bool stands = same[n] && !old.version->due();
        running[n].outputs = std::move(old.outputs);
        running[n].kept = std::move(old.kept);
        if (sameLoop(graph, *checked, n, uint32_t(before))) running[n].passes = std::move(old.passes);
        // Loops within may hold other nodes than before.
        for (Pass& pass : running[n].passes)
            for (Made& made : pass.nodes) made.passes.clear();
        running[n].evaluations = old.evaluations;
        running[n].ms = old.ms;
        if (!stands) continue;
        running[n].failure = old.failure;
        running[n].note = old.note;
        running[n].blocked = old.blocked;
        running[n].version->made();
    }
    const bool shows = std::ranges::equal(checked->shown, checked_.shown, [&](uint32_t a, uint32_t b) {
        return graph.nodes[a].name == graph_.nodes[b].name;
    });
    if (!shows) shownRevision_ = nextVersion();
    dropVersions();
    running_ = std::move(running);
    graph_ = std::move(graph);
    checked_ = std::move(*checked);
    names_ = std::move(names);
    pulled_ = pulledBy(checked_.shown);
    std::vector<graph::Node*> shown;
    for (const uint32_t n : checked_.shown) shown.push_back(running_[n].version.get());
    shownVersion_ = std::make_unique<graph::Node>(std::move(shown));
    return Done{};
}

// What has to be made for these, in order.
std::vector<uint32_t> NodeEvaluation::pulledBy(std::vector<uint32_t> roots) const {
    std::vector<bool> wanted(checked_.nodes.size());
    for (const uint32_t n : roots) wanted[n] = true;
    for (size_t i = checked_.order.size(); i-- > 0;)
        if (wanted[checked_.order[i]])
            for (const CheckedGraph::Wire& wire : checked_.nodes[checked_.order[i]].wires) wanted[wire.node] = true;
    std::vector<uint32_t> pulled;
    for (const uint32_t n : checked_.order)
        if (wanted[n]) pulled.push_back(n);
    return pulled;
}

Status NodeEvaluation::setInput(std::string_view node, std::string_view port, const Literal& value) {
    const int n = find(node);
    if (n < 0) return Failure(graph_.file, "there is no node '" + std::string(node) + "'");
    const NodeKind* kind = checked_.nodes[size_t(n)].kind;
    const int at = kind ? kind->port(port) : -1;
    const auto refuse = [&](const std::string& why) {
        return Failure({graph_.file, 0, 0, std::string(node), "'" + std::string(port) + "' " + why, false});
    };
    if (at < 0) return refuse("is no input of it");
    for (const CheckedGraph::Wire& wire : checked_.nodes[size_t(n)].wires)
        if (wire.port == uint32_t(at)) return refuse("is wired to another node");
    if (const std::string wrong = mistakeInConstant(value, kind->inputs[size_t(at)]); !wrong.empty())
        return refuse(wrong);
    Literal& now = checked_.nodes[size_t(n)].constants[size_t(at)];
    if (now == value) return Done{};
    now = value;
    std::vector<NodeInput>& inputs = graph_.nodes[size_t(n)].inputs;
    const auto place = std::ranges::find_if(inputs, [&](const NodeInput& i) { return kind->port(i.port) >= at; });
    if (place != inputs.end() && place->port == port)
        place->constant = value;
    else
        inputs.insert(place, NodeInput{std::string(port), value, {}, {}, {}});
    running_[size_t(n)].version->change();
    return Done{};
}

void NodeEvaluation::setTime(const GraphTime& time) {
    if (time == time_) return;
    time_ = time;
    for (uint32_t n = 0; n < running_.size(); ++n)
        if (checked_.nodes[n].kind && checked_.nodes[n].kind->readsTime) running_[n].version->change();
}

bool NodeEvaluation::due() const {
    return shownVersion_ && shownVersion_->due();
}

Status NodeEvaluation::evaluate() {
    if (!due()) return Done{};
    const Status made = make(pulled_);
    if (made) shownVersion_->made();
    return made;
}

Status NodeEvaluation::make(const std::vector<uint32_t>& pulled) {
    const auto begin = std::chrono::steady_clock::now();
    NodeWorkList list;
    Stats measured;
    std::vector<uint32_t> due;
    for (const uint32_t n : pulled) {
        if (!running_[n].version->due()) continue;
        due.push_back(n);
        const Status possible = timed_ ? makeTimed(n, list, measured) : makeNode(n, list);
        if (!possible) return forget(due, possible);
    }
    if (due.empty()) return Done{};
    stats_ = {uint32_t(running_.size()), uint32_t(due.size()), measured.kernels + uint32_t(list.stages.size()),
              measured.dispatches, 0};
    if (!timed_) {
        if (Status ran = machine_->run(std::move(list)); !ran) return forget(due, ran);
        stats_.dispatches = machine_->dispatches();
    }
    for (const uint32_t n : due) {
        running_[n].version->made();
        ++running_[n].evaluations;
        if (!timed_) running_[n].ms.reset();
    }
    stats_.ms = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
    revision_ = shownRevision_ = nextVersion();
    return Done{};
}

// With all of its kernels, so that what it takes is its own.
Status NodeEvaluation::makeTimed(uint32_t n, NodeWorkList& list, Stats& measured) {
    const auto begin = std::chrono::steady_clock::now();
    if (Status possible = makeNode(n, list); !possible) return possible;
    measured.kernels += uint32_t(list.stages.size());
    if (Status ran = machine_->run(std::exchange(list, {})); !ran) return ran;
    measured.dispatches += machine_->dispatches();
    running_[n].ms = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
    return Done{};
}

// What was to be in memory isn't.
Status NodeEvaluation::forget(const std::vector<uint32_t>& due, Status failed) {
    for (const uint32_t n : due) {
        for (NodeSlot& slot : running_[n].kept.slots) slot.madeFrom = 0;
        running_[n].kept.memory.reset();
        running_[n].passes.clear();
    }
    return failed;
}

// Fails only where the device does.
Status NodeEvaluation::makeIn(const Scope* scope, uint32_t n, Made& made, NodeWorkList& list) {
    const CheckedGraph::Node& node = checked_.nodes[n];
    made.failure.clear();
    made.note.clear();
    made.blocked = false;
    if (!node.kind) {
        made.failure = "there is no kind of node '" + graph_.nodes[n].kind + "'";
        return Done{};
    }
    if (!node.missing.empty()) {
        made.failure = node.missing;
        return Done{};
    }
    NodeWork::Given given{*node.kind, node.constants, {}, time_, files_, graph_.file};
    given.wires.resize(node.kind->inputs.size());
    for (const CheckedGraph::Wire& wire : node.wires) {
        const Made& from = madeIn(scope, wire.node);
        made.blocked = made.blocked || !from.failure.empty() || from.blocked || from.outputs.size() <= wire.output;
        if (!made.blocked) given.wires[wire.port].push_back(&from.outputs[wire.output]);
    }
    if (made.blocked) return Done{};
    if (node.muted) {
        made.outputs.assign(1, *given.wires.front().front());
        return Done{};
    }
    if (scope && scope->loop->opener == n) given.pass = scope->given;
    if (node.loop >= 0) {
        given.makePass = [&](const LoopPass& pass) { return makePass(scope, n, made, pass, list); };
        given.passReads = checked_.loops[size_t(node.loop)].reads;
    }
    const size_t stages = list.stages.size(), uploads = list.uploads.size();
    NodeWork work(std::move(given), *machine_, made.kept, list);
    const Status done = node.kind->make(work);
    if (done) {
        made.outputs = std::move(work.outputs());
        made.note = work.noted();
        return Done{};
    }
    if (done.failure().ofDevice()) return done;
    made.failure = done.failure().diagnostics.front().message;
    // Nothing of it runs, so nothing of it may be taken for made.
    list.stages.resize(std::min(stages, list.stages.size()));
    list.uploads.resize(std::min(uploads, list.uploads.size()));
    for (NodeSlot& slot : made.kept.slots) slot.madeFrom = 0;
    made.passes.clear();
    return Done{};
}

std::vector<NodeEvaluation::Shown> NodeEvaluation::shownValues() const {
    std::vector<Shown> all;
    for (const uint32_t n : checked_.shown)
        all.push_back({n, running_[n].outputs.empty() ? nullptr : &running_[n].outputs.front()});
    return all;
}

Geometry NodeEvaluation::shown() const {
    Geometry all;
    for (const Shown& each : shownValues())
        if (const auto* parts = each.value ? std::get_if<Geometry>(each.value) : nullptr)
            all.insert(all.end(), parts->begin(), parts->end());
    return all;
}

Result<const NodeValue*> NodeEvaluation::inspect(std::string_view node, std::string_view output) {
    const int n = find(node);
    if (n < 0 || !checked_.nodes[size_t(n)].kind) return static_cast<const NodeValue*>(nullptr);
    const int at = checked_.nodes[size_t(n)].kind->output(output);
    if (at < 0) return static_cast<const NodeValue*>(nullptr);
    if (Status made = make(pulledBy({uint32_t(n)})); !made) return made.failure();
    const std::vector<NodeValue>& outputs = running_[size_t(n)].outputs;
    return size_t(at) < outputs.size() ? &outputs[size_t(at)] : nullptr;
}

std::optional<NodeEvaluation::NodeState> NodeEvaluation::state(std::string_view node, size_t output) const {
    const int n = find(node);
    if (n < 0) return {};
    const Running& running = running_[size_t(n)];
    NodeState state{nullptr, &running.failure, &running.note, running.blocked, running.evaluations, running.ms};
    if (output < running.outputs.size()) state.value = &running.outputs[output];
    return state;
}

Result<std::vector<glm::vec3>> NodeEvaluation::places(const GeometryPart& part) {
    const NodeKind none;
    NodeKept kept;
    NodeWorkList list;
    const NodeFiles files;
    NodeWork work({none, {}, {}, time_, files, graph_.file}, *machine_, kept, list);
    return work.placesNow(part);
}

std::vector<Diagnostic> NodeEvaluation::failures() const {
    std::vector<Diagnostic> all;
    for (uint32_t n = 0; n < running_.size(); ++n) {
        const GraphNode& node = graph_.nodes[n];
        if (!running_[n].failure.empty())
            all.push_back({graph_.file, node.place.line, node.place.column, node.name, running_[n].failure, false});
    }
    return all;
}

std::vector<Diagnostic> NodeEvaluation::notes() const {
    std::vector<Diagnostic> all;
    for (uint32_t n = 0; n < running_.size(); ++n) {
        const GraphNode& node = graph_.nodes[n];
        if (!running_[n].note.empty())
            all.push_back({graph_.file, node.place.line, node.place.column, node.name, running_[n].note, true});
    }
    return all;
}

}  // namespace espalier
