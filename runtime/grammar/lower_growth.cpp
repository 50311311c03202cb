// Growing symbols -> symbol, rule and successor records (Buron 2015 §5, §7).
//
// The continuation: the successor by which a rule reaches Marching again in its own cycle, that is, the first in the
// same strongly connected component as the predecessor. Where the component ends (a stem that turns into a twig, a
// seed's first rule) the first growing successor carries the branch on. All other successors begin branches.
#include <algorithm>
#include <unordered_map>

#include "runtime/grammar/compilation.hpp"

namespace espalier::grammar {
namespace {

struct Call {
    const Element* element;
    uint32_t symbol;
};

class GrowthLowering {
  public:
    explicit GrowthLowering(Compilation& c) : c_(c) {
        for (uint32_t i = 0; i < kMaxArgs; ++i) args_[i] = c.graph.leaf(Leaf::slot, kSlotArg + i);
    }

    void run() {
        findReachable();
        for (Symbol& symbol : c_.symbols)
            if (symbol.grows) lowerSymbol(symbol);
        if (!c_.reporter.failed()) checkExtrudedArgs();
    }

  private:
    // A sequence in which growing symbols may stand; NULL and what vanishes is left out.
    std::vector<Call> calls(const Sequence& sequence, const std::string& rule) {
        std::vector<Call> all;
        for (const Element& e : sequence) addCalls(e, rule, all);
        return all;
    }
    void addCalls(const Element& e, const std::string& rule, std::vector<Call>& all) {
        const BlockInfo* block = findBlock(e);
        const CommandInfo* command = findCommand(e.name);
        if (block != nullptr && block->kind == Block::branch) {
            branch(e, *block, rule, all);
        } else if (block != nullptr) {
            if (isRoofBlock(block->kind))
                return c_.reporter.error(e.place, rule,
                                         "'" + e.name + "' makes roofs; a grammar either marches or makes roofs");
            if (isOfPatterns(block->kind))
                return c_.reporter.error(
                    e.place, rule, "'" + e.name + "' belongs to patterns; a grammar either marches or makes patterns");
            bool marching = block->kind == Block::marching;
            c_.reporter.error(e.place, rule,
                              marching ? "Marching stands alone behind the arrow; give it a rule of its own"
                                       : "Repeat belongs in what an extruded successor draws");
        } else if (command != nullptr && command->kind != Command::null) {
            c_.reporter.error(
                e.place, rule,
                "'" + e.name +
                    "' draws, but here nothing has been extruded yet; put it into Marching's second successor");
        } else if (command == nullptr) {
            uint32_t callee = c_.findSymbol(e.name);
            if (callee == kNoSymbol) return;  // reported
            const Symbol& symbol = c_.symbols[callee];
            if (!c_.checkArgs(e, symbol, rule)) return;
            if (symbol.grows)
                all.push_back({&e, callee});
            else if (!symbol.vanishes)
                c_.reporter.error(
                    e.place, rule,
                    "'" + e.name + "' draws and never reaches Marching; put it into Marching's second successor");
        }
    }
    void branch(const Element& e, const BlockInfo& info, const std::string& rule, std::vector<Call>& all) {
        if (!e.hasItems || e.args.size() > info.maxArgs || e.items.size() > info.maxItems) {
            c_.reporter.error(e.place, rule, "write " + std::string(info.usage));
            return;
        }
        if (!e.args.empty()) {
            Env env;
            env.rule = rule;
            Node n = c_.expressions.lower(e.args[0], env);
            if (!c_.graph.isMistaken(n) && !c_.graph.isConstant(n, static_cast<float>(e.items.size())))
                c_.reporter.error(e.place, rule,
                                  "Branch's number must be that of its successors, " + std::to_string(e.items.size()));
        }
        for (const Sequence& item : e.items)
            for (const Element& inner : item) addCalls(inner, rule, all);
    }

    // reach_[a][b]: a derives b, by one rule or more.
    void findReachable() {
        size_t n = c_.symbols.size();
        reach_.assign(n, std::vector<bool>(n, false));
        std::vector<std::vector<uint32_t>> next(n);
        for (uint32_t s = 0; s < n; ++s)
            for (uint32_t r : c_.symbols[s].rules)
                forEachElement(c_.module.rules[r].successor, [&](const Element& e) {
                    uint32_t callee = c_.findSymbol(e.name);
                    if (callee != kNoSymbol) next[s].push_back(callee);
                });
        for (uint32_t s = 0; s < n; ++s) {
            std::vector<uint32_t> open = next[s];
            while (!open.empty()) {
                uint32_t t = open.back();
                open.pop_back();
                if (reach_[s][t]) continue;
                reach_[s][t] = true;
                open.insert(open.end(), next[t].begin(), next[t].end());
            }
        }
    }
    size_t continuation(uint32_t predecessor, const std::vector<Call>& all) const {
        for (size_t i = 0; i < all.size(); ++i)
            if (reach_[all[i].symbol][predecessor]) return i;
        return 0;
    }

    void lowerSymbol(Symbol& symbol) {
        std::vector<Env> envs = c_.lowerChoice(symbol, args_);
        const size_t firstRule = c_.symbolRecords[symbol.record].firstRule;
        for (uint32_t i = 0; i < symbol.rules.size(); ++i) {
            const Rule& rule = c_.module.rules[symbol.rules[i]];
            const BlockInfo* block = rule.successor.size() == 1 ? findBlock(rule.successor[0]) : nullptr;
            if (block != nullptr && block->kind == Block::marching)
                march(symbol, rule, i, envs[i], firstRule + i);
            else
                list(symbol, rule, envs[i], firstRule + i);
        }
    }

    SuccessorRecord successorOf(const Call& call, const std::vector<Call>& all, size_t i) const {
        SuccessorRecord s = {};
        s.symbol = c_.symbols[call.symbol].record;
        s.nameHash = nameHash(c_.symbols[call.symbol].name);
        s.argCount = c_.symbols[call.symbol].argCount;
        for (size_t before = 0; before < i; ++before) s.ordinal += all[before].symbol == call.symbol ? 1 : 0;
        for (Value& v : s.args) v = {kSlotImmediate, 0};
        return s;
    }
    // Which argument each of a continuation's arguments hands on unchanged.
    void noteFlow(uint32_t from, const Call& call, const std::vector<Node>& nodes) {
        uint32_t kept = 0;
        for (uint32_t i = 0; i < nodes.size() && i < c_.symbols[from].argCount; ++i)
            if (nodes[i] == args_[i]) kept |= 1u << i;
        flows_.push_back({from, call.symbol, kept});
    }

    // Whether the node's value is the same wherever a step leads: made of arguments, draws, the step's number.
    bool blind(Node n) {
        const auto [known, fresh] = blind_.try_emplace(n, true);
        if (!fresh) return known->second;
        const GraphNode& g = c_.graph[n];
        bool all = g.leaf != Leaf::slot || (g.op >= kSlotArg && g.op < kSlotArg + kMaxArgs) || g.op == kSlotDepth ||
                   g.op == kSlotStep;
        for (uint32_t i = 0; i < g.kidCount; ++i) all = all && blind(g.kids[i]);
        return blind_[n] = all;
    }
    // What of a condition's conjunction is so: where that fails, no other direction helps. kNone: nothing.
    Node blindPart(Node condition, uint32_t depth = 0) {
        constexpr uint32_t kMostDepth = 8;
        if (blind(condition)) return condition;
        const GraphNode g = c_.graph[condition];
        const bool both =
            g.leaf == Leaf::operation && g.op == kOpMin && c_.graph[g.kids[0]].boolean && c_.graph[g.kids[1]].boolean;
        if (!both || depth == kMostDepth) return Graph::kNone;
        const Node a = blindPart(g.kids[0], depth + 1), b = blindPart(g.kids[1], depth + 1);
        return a == Graph::kNone ? b : b == Graph::kNone ? a : c_.graph.both(a, b);
    }

    void march(const Symbol& symbol, const Rule& rule, uint32_t ordinal, Env& env, size_t index) {
        const Element& e = rule.successor[0];
        const BlockInfo& info = *findBlock(e);
        if (!e.hasItems || e.args.size() < info.minArgs || e.args.size() > info.maxArgs ||
            e.items.size() > info.maxItems || e.items.empty()) {
            c_.reporter.error(
                e.place, symbol.name,
                "write " + std::string(info.usage) + "; without a length, the parameter 'length' is taken");
            return;
        }
        size_t a = e.args.size() - 2;  // 1 if the length is given
        Node length = a == 1 ? c_.expressions.lower(e.args[0], env) : defaultLength(e, env);
        if (c_.graph.isConstant(length) && c_.graph[length].value <= 0)
            c_.reporter.error(e.place, symbol.name, "the marching length must be positive");
        Node start[2] = {length, c_.expressions.lower(e.args[a], env)};
        std::vector<Node> arrive = {c_.expressions.lower(e.args[a + 1], env)};

        std::vector<Call> top = calls(e.items[0], symbol.name);
        if (top.size() > 1) {
            c_.reporter.error(e.place, symbol.name,
                              "Marching goes on with one successor; give the others a Branch rule of their own");
            return;
        }
        SuccessorRecord successor = {};
        if (!top.empty()) {
            successor = successorOf(top[0], top, 0);
            for (ExprId arg : top[0].element->args) arrive.push_back(c_.expressions.lower(arg, env));
            noteFlow(self(symbol), top[0], {arrive.begin() + 1, arrive.end()});
        }

        RuleRecord r = {};
        StageReads sites, before, after;
        const Node blindNode = blindPart(arrive[0]);
        if (blindNode != Graph::kNone) arrive.push_back(blindNode);
        Value starts[2], arrives[2 + kMaxArgs];
        c_.generate(start, sites, before, r.start, starts, e.place, symbol.name);
        c_.generate(arrive, sites, after, r.arrive, {arrives, arrive.size()}, e.place, symbol.name);
        r.kind = kRuleMarch;
        r.distance = starts[0];
        r.angle = starts[1];
        r.condition = arrives[0];
        const uint32_t blindSlot = blindNode == Graph::kNone ? kSlotImmediate : arrives[arrive.size() - 1].slot;
        if (blindSlot < kMachineSlots) r.values = blindSlot + 1;
        r.startInputs = before.inputs;
        r.startLayers = before.layers;
        r.arriveInputs = after.inputs;
        r.arriveLayers = after.layers;
        r.params = before.params | after.params;
        r.firstSite = c_.storeSites(sites);
        r.siteCount = static_cast<uint32_t>(sites.sites.size());
        r.firstSuccessor = static_cast<uint32_t>(c_.successors.size());
        if (!top.empty()) {
            successor.flags = kSuccessorContinues;
            std::copy_n(arrives + 1, successor.argCount, successor.args);
            c_.successors.push_back(successor);
            r.successorCount = 1;
        }
        if (e.items.size() > 1) {
            r.extrude = lowerExtrude(c_, rule, ordinal, e.items[1], args_);
            if (r.extrude != 0) extrudedAt_.push_back({self(symbol), r.extrude - 1, e.place});
        }
        c_.rules[index] = r;
    }
    uint32_t self(const Symbol& symbol) const { return static_cast<uint32_t>(&symbol - c_.symbols.data()); }
    Node defaultLength(const Element& e, Env& env) {
        if (c_.expressions.known("length")) return c_.expressions.lowerName("length", e.place, env);
        c_.reporter.error(e.place, env.rule, "Marching has no length; give one, or declare: param length = 0.05");
        return c_.graph.one();
    }

    void list(const Symbol& symbol, const Rule& rule, Env& env, size_t index) {
        std::vector<Call> all = calls(rule.successor, symbol.name);
        if (all.size() > kMaxSuccessors) {
            c_.reporter.error(rule.place, symbol.name, "too many successors: 16 are the most");
            return;
        }
        RuleRecord r = {};
        r.kind = all.empty() ? kRuleNull : kRuleList;
        r.distance = r.angle = r.condition = {kSlotImmediate, 0};
        r.firstSuccessor = static_cast<uint32_t>(c_.successors.size());
        r.successorCount = static_cast<uint32_t>(all.size());
        size_t goesOn = continuation(self(symbol), all);
        StageReads sites, reads;
        for (size_t i = 0; i < all.size(); ++i) {
            SuccessorRecord s = successorOf(all[i], all, i);
            std::vector<Node> nodes;
            for (ExprId arg : all[i].element->args) nodes.push_back(c_.expressions.lower(arg, env));
            c_.generate(nodes, sites, reads, s.code, {s.args, nodes.size()}, all[i].element->place, symbol.name);
            if (i == goesOn) {
                s.flags = kSuccessorContinues;
                noteFlow(self(symbol), all[i], nodes);
            }
            c_.successors.push_back(s);
        }
        r.startInputs = reads.inputs;
        r.startLayers = reads.layers;
        r.params = reads.params;
        r.firstSite = c_.storeSites(sites);
        r.siteCount = static_cast<uint32_t>(sites.sites.size());
        c_.rules[index] = r;
    }

    // An extruded successor runs in the second pass, when of its rule's arguments only those of the chunk's entry
    // are left: it may use what every continuation on the way to that rule hands on unchanged.
    void checkExtrudedArgs() {
        for (const auto& [symbol, extrude, place] : extrudedAt_) {
            uint32_t wanted = c_.extrudes[extrude].argMask;
            if (wanted == 0) continue;
            std::vector<bool> before(c_.symbols.size(), false);
            before[symbol] = true;
            uint32_t kept = 0xFu;
            for (bool changed = true; changed;) {
                changed = false;
                for (const Flow& f : flows_) {
                    if (!before[f.to]) continue;
                    kept &= f.kept;
                    changed = changed || !before[f.from];
                    before[f.from] = true;
                }
            }
            if ((wanted & ~kept) != 0)
                c_.reporter.error(place, c_.symbols[symbol].name,
                                  "an extruded successor may use only arguments that the branch hands on unchanged; "
                                  "use step, arc, toTip or depth instead");
        }
    }

    struct Flow {
        uint32_t from, to, kept;
    };
    struct ExtrudedAt {
        uint32_t symbol, extrude;
        Place place;
    };
    Compilation& c_;
    Node args_[kMaxArgs];
    std::vector<std::vector<bool>> reach_;
    std::vector<Flow> flows_;
    std::unordered_map<Node, bool> blind_;
    std::vector<ExtrudedAt> extrudedAt_;
};

}  // namespace

void lowerGrowth(Compilation& c) {
    GrowthLowering(c).run();
    for (const Symbol& symbol : c.symbols)
        if (symbol.grows) {
            c.startSymbol = symbol.record;  // symbols stand in the text's order, the main text first
            break;
        }
}

}  // namespace espalier::grammar
