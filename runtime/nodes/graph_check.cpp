// In: nodes as a text has them. Out: wires by number, in an order in which what is read comes first, or what is wrong.
#include <algorithm>
#include <cmath>
#include <unordered_map>

#include "runtime/grammar/vocabulary.hpp"
#include "runtime/nodes/node_graph.hpp"

namespace espalier {
namespace {

constexpr size_t kMostMistakes = 20;
constexpr uint32_t kNone = ~0u;

class Checker {
  public:
    Checker(const NodeGraph& graph, bool unfinished) : graph_(graph), unfinished_(unfinished) {}

    Result<CheckedGraph> run() {
        nameNodes();
        for (uint32_t n = 0; n < graph_.nodes.size(); ++n) wireNode(n);
        putInOrder();
        muteNodes();
        if (mistakes_.empty())
            for (uint32_t n : out_.order) checkNode(n);
        if (mistakes_.empty())
            for (uint32_t n : out_.order) findLoop(n);
        for (const auto& [name, place] : graph_.shown) {
            const uint32_t n = nodeNamed(name);
            if (n == kNone)
                mistake(place, "show", "there is no node '" + name + "'" + hint(name));
            else
                out_.shown.push_back(n);
        }
        if (!mistakes_.empty()) return Failure(std::move(mistakes_));
        return std::move(out_);
    }

  private:
    void mistake(const TextPlace& place, const std::string& node, std::string message) {
        if (mistakes_.size() < kMostMistakes)
            mistakes_.push_back({graph_.file, place.line, place.column, node, std::move(message), false});
    }
    uint32_t nodeNamed(const std::string& name) const {
        const auto found = numbers_.find(name);
        return found == numbers_.end() ? kNone : found->second;
    }
    // Names that are near in a large graph take long to find.
    std::string hint(const std::string& wanted) const {
        if (graph_.nodes.size() > 1000) return {};
        std::vector<std::string> names;
        for (const GraphNode& node : graph_.nodes) names.push_back(node.name);
        return grammar::didYouMean(wanted, names);
    }

    void nameNodes() {
        out_.nodes.resize(graph_.nodes.size());
        for (uint32_t n = 0; n < graph_.nodes.size(); ++n) {
            const GraphNode& node = graph_.nodes[n];
            if (!numbers_.emplace(node.name, n).second)
                mistake(node.place, node.name, "another node has this name already");
            CheckedGraph::Node& made = out_.nodes[n];
            made.kind = findNodeKind(node.kind);
            if (made.kind) {
                for (const NodePort& port : made.kind->inputs) made.constants.push_back(port.standard);
                for (const NodeOutput& output : made.kind->outputs) made.outputs.push_back(output.type);
                continue;
            }
            std::vector<std::string> kinds;
            for (const NodeKind& kind : nodeKinds()) kinds.push_back(kind.name);
            out_.warnings.push_back(
                {graph_.file, node.place.line, node.place.column, node.name,
                 "there is no kind of node '" + node.kind + "'" + grammar::didYouMean(node.kind, kinds), true});
        }
    }

    void wireNode(uint32_t n) {
        const GraphNode& node = graph_.nodes[n];
        CheckedGraph::Node& made = out_.nodes[n];
        for (uint32_t i = 0; i < node.inputs.size(); ++i) {
            const NodeInput& input = node.inputs[i];
            const int port = made.kind ? made.kind->port(input.port) : int(i);
            if (port < 0) {
                std::vector<std::string> ports;
                for (const NodePort& p : made.kind->inputs) ports.push_back(p.name);
                mistake(
                    input.place, node.name,
                    made.kind->name + " has no input '" + input.port + "'" + grammar::didYouMean(input.port, ports));
                continue;
            }
            if (made.kind && i > 0 && node.inputs[i - 1].port == input.port && !made.kind->inputs[size_t(port)].many)
                mistake(input.place, node.name, "the input '" + input.port + "' is given twice");
            if (input.constant.kind != Literal::Kind::none) {
                if (made.kind) takeConstant(node, input, made.kind->inputs[size_t(port)], made.constants[size_t(port)]);
                continue;
            }
            const uint32_t from = nodeNamed(input.from);
            if (from == kNone) {
                mistake(input.place, node.name, "there is no node '" + input.from + "'" + hint(input.from));
                continue;
            }
            const NodeKind* kind = out_.nodes[from].kind;
            const int output = kind ? kind->output(input.output) : 0;
            if (output < 0) {
                mistake(input.place, node.name,
                        "'" + input.from + "' (" + kind->name + ") has no output '" + input.output + "'");
                continue;
            }
            const std::string opener = made.kind ? made.kind->inputs[size_t(port)].opener : "";
            if (!opener.empty() && (!kind || kind->name != opener)) {
                mistake(input.place, node.name,
                        "'" + input.port + "' takes a wire to " + opener + ", but '" + input.from + "' is " +
                            graph_.nodes[from].kind);
                continue;
            }
            made.wires.push_back({uint32_t(port), from, uint32_t(output)});
        }
    }

    void takeConstant(const GraphNode& node, const NodeInput& input, const NodePort& port, Literal& into) {
        const std::string wrong = mistakeInConstant(input.constant, port);
        if (wrong.empty())
            into = input.constant;
        else
            mistake(input.place, node.name, "'" + port.name + "' " + wrong);
    }

    void muteNodes() {
        for (const auto& [name, place] : graph_.muted) {
            const uint32_t n = nodeNamed(name);
            if (n == kNone) {
                mistake(place, "mute", "there is no node '" + name + "'" + hint(name));
                continue;
            }
            const NodeKind* kind = out_.nodes[n].kind;
            if (kind && (kind->inputs.empty() || kind->inputs.front().type < ValueType::material))
                mistake(place, "mute", "'" + name + "' (" + kind->name + ") can't be muted: nothing goes through it");
            out_.nodes[n].muted = true;
        }
    }

    // Each node behind those that it reads; where that can't be, the way around is told.
    void putInOrder() {
        const uint32_t count = uint32_t(out_.nodes.size());
        std::vector<uint8_t> state(count, 0);  // 1: on the way, 2: done
        std::vector<std::pair<uint32_t, uint32_t>> way;
        for (uint32_t start = 0; start < count; ++start) {
            if (state[start] != 0) continue;
            way.assign(1, {start, 0});
            state[start] = 1;
            while (!way.empty()) {
                auto& [n, next] = way.back();
                if (next == out_.nodes[n].wires.size()) {
                    state[n] = 2;
                    out_.order.push_back(n);
                    way.pop_back();
                    continue;
                }
                const uint32_t from = out_.nodes[n].wires[next++].node;
                if (state[from] == 1) return tellCircle(way, from);
                if (state[from] != 0) continue;
                state[from] = 1;
                way.emplace_back(from, 0);
            }
        }
    }
    void tellCircle(const std::vector<std::pair<uint32_t, uint32_t>>& way, uint32_t from) {
        constexpr size_t kMostTold = 16;
        const auto name = [&](uint32_t n) { return graph_.nodes[n].name; };
        // The way leads from who reads to what is read; it is told the other way, as wires do.
        std::string path = name(from);
        size_t told = 1;
        for (size_t at = way.size(); way[at - 1].first != from && told < kMostTold; --at, ++told)
            path += " -> " + name(way[at - 1].first);
        if (told == kMostTold) path += " -> ...";
        path += " -> " + name(from);
        mistake(graph_.nodes[from].place, graph_.nodes[from].name, "wires go round in a circle: " + path);
    }

    void checkNode(uint32_t n) {
        const GraphNode& node = graph_.nodes[n];
        CheckedGraph::Node& made = out_.nodes[n];
        if (!made.kind) return;
        for (const CheckedGraph::Wire& wire : made.wires) {
            const CheckedGraph::Node& from = out_.nodes[wire.node];
            if (!from.kind || from.unsure) continue;  // it gives nothing, which is told when the graph runs
            const NodePort& port = made.kind->inputs[wire.port];
            const ValueType given = from.outputs[wire.output];
            if (*port.opener) continue;  // the node is meant, whatever it gives
            if (!accepts(port.type, given)) {
                const auto input = std::ranges::find_if(node.inputs, [&](const NodeInput& i) {
                    return i.constant.kind == Literal::Kind::none && i.port == port.name;
                });
                mistake(input->place, node.name,
                        "'" + port.name + "' takes " + nameOf(port.type) + ", but '" + graph_.nodes[wire.node].name +
                            "' gives " + nameOf(given));
            }
        }
        for (uint32_t p = 0; p < made.kind->inputs.size(); ++p) {
            const NodePort& port = made.kind->inputs[p];
            const bool wired =
                std::ranges::any_of(made.wires, [&](const CheckedGraph::Wire& w) { return w.port == p; });
            if (wired || made.constants[p].kind != Literal::Kind::none || port.optional) continue;
            const std::string missing = "'" + port.name + "' is missing: " + made.kind->name + " needs a wire to " +
                                        (*port.opener ? port.opener : nameOf(port.type));
            if (!unfinished_) mistake(node.place, node.name, missing);
            if (made.missing.empty()) made.missing = missing;
        }
        for (uint32_t o = 0; o < made.outputs.size(); ++o)
            if (made.kind->outputs[o].asInput || (made.muted && o == 0)) takeTypeOfFirst(made, o);
    }
    void takeTypeOfFirst(CheckedGraph::Node& made, uint32_t output) {
        const bool wired = !made.wires.empty() && made.wires.front().port == 0;
        const CheckedGraph::Node* from = wired ? &out_.nodes[made.wires.front().node] : nullptr;
        made.unsure = !from || !from->kind || from->unsure;
        if (!made.unsure) made.outputs[output] = from->outputs[made.wires.front().output];
    }

    // What a node repeats: of all that its repeated input reads, what reads the opener.
    void findLoop(uint32_t n) {
        CheckedGraph::Node& made = out_.nodes[n];
        if (!made.kind || !*made.kind->repeats || !made.missing.empty()) return;
        if (out_.loops.size() == NodeGraph::kMostLoops)
            return mistake(graph_.nodes[n].place, graph_.nodes[n].name,
                           "a graph has at most " + std::to_string(NodeGraph::kMostLoops) + " nodes that repeat");
        CheckedGraph::Loop loop;
        for (const CheckedGraph::Wire& wire : made.wires) {
            if (*made.kind->inputs[wire.port].opener) loop.opener = wire.node;
            if (made.kind->inputs[wire.port].name == made.kind->repeats) loop.root = wire;
        }
        std::vector<bool> read(out_.nodes.size()), differs(out_.nodes.size());
        read[loop.root.node] = differs[loop.opener] = true;
        for (size_t i = out_.order.size(); i-- > 0;)
            if (read[out_.order[i]])
                for (const CheckedGraph::Wire& wire : out_.nodes[out_.order[i]].wires) read[wire.node] = true;
        for (const uint32_t b : out_.order) {
            if (!read[b]) continue;
            for (const CheckedGraph::Wire& wire : out_.nodes[b].wires) {
                if (differs[wire.node]) differs[b] = true;
                if (wire.node == loop.opener) loop.reads |= 1u << wire.output;
            }
            if (!differs[b]) continue;
            loop.at.emplace(b, uint32_t(loop.body.size()));
            loop.body.push_back(b);
        }
        made.loop = int(out_.loops.size());
        out_.loops.push_back(std::move(loop));
    }

    const NodeGraph& graph_;
    const bool unfinished_;
    std::unordered_map<std::string, uint32_t> numbers_;
    CheckedGraph out_;
    std::vector<Diagnostic> mistakes_;
};

}  // namespace

std::string mistakeInConstant(const Literal& given, const NodePort& port) {
    const bool number = given.kind == Literal::Kind::number, text = given.kind == Literal::Kind::text;
    if (*port.opener) return std::string("takes a wire to ") + port.opener;
    switch (port.type) {
        case ValueType::number:
            if (!number) return "takes a number";
            break;
        case ValueType::whole:
            if (!number || given.numbers.x != std::floor(given.numbers.x)) return "takes a whole number";
            break;
        case ValueType::vector:
        case ValueType::colour:
            if (given.kind != Literal::Kind::vector) return "takes three numbers, as (0, 1, 0)";
            break;
        case ValueType::choice: {
            if (text && std::ranges::find(port.words, given.text) != port.words.end()) return {};
            std::string words;
            for (const std::string& word : port.words) words += (words.empty() ? "\"" : ", \"") + word + "\"";
            return "takes one of " + words;
        }
        case ValueType::text:
        case ValueType::file:
            return text ? "" : "takes a text in quotes";
        default:
            return std::string("takes a wire to ") + nameOf(port.type);
    }
    for (int i = 0; i < (number ? 1 : 3); ++i)
        if (!(given.numbers[i] >= port.low && given.numbers[i] <= port.high))
            return "is " + numberText(given.numbers[i]) + ", which isn't " + numberText(port.low) + " to " +
                   numberText(port.high);
    return {};
}

Result<CheckedGraph> checkGraph(const NodeGraph& graph, bool unfinished) {
    return Checker(graph, unfinished).run();
}

}  // namespace espalier
