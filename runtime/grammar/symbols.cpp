// Which symbols grow (reach Marching), which draw, and whether derivation always gets on: a cycle of rules without
// Marching would never end, so it is refused here, whatever conditions stand in it.
#include <algorithm>
#include <utility>

#include "runtime/grammar/compilation.hpp"

namespace espalier::grammar {
namespace {

bool isCall(const Element& e) {
    return findBlock(e) == nullptr && findCommand(e.name) == nullptr;
}

const BlockInfo* wholeBlock(const Rule& rule, Block kind) {
    if (rule.successor.size() != 1) return nullptr;
    const BlockInfo* block = findBlock(rule.successor[0]);
    return block != nullptr && block->kind == kind ? block : nullptr;
}

void collect(Compilation& c) {
    for (uint32_t i = 0; i < c.module.rules.size(); ++i) {
        const Rule& rule = c.module.rules[i];
        std::string reserved = reservedFor(rule.predecessor);
        if (!reserved.empty())
            c.reporter.error(rule.place, rule.predecessor, reserved + "; a predecessor needs another");
        if (c.expressions.known(rule.predecessor))
            c.reporter.error(rule.place, rule.predecessor, "'" + rule.predecessor + "' is declared as a value already");
        if (rule.args.size() > kMaxArgs)
            c.reporter.error(rule.place, rule.predecessor, "too many arguments: 4 are the most");
        for (size_t a = 0; a < rule.args.size(); ++a)
            if (std::find(rule.args.begin(), rule.args.begin() + static_cast<long>(a), rule.args[a]) !=
                rule.args.begin() + static_cast<long>(a))
                c.reporter.error(rule.place, rule.predecessor, "two arguments are named '" + rule.args[a] + "'");
        auto [found, fresh] = c.symbolByName.emplace(rule.predecessor, static_cast<uint32_t>(c.symbols.size()));
        if (fresh) {
            Symbol symbol;
            symbol.name = rule.predecessor;
            symbol.argCount = static_cast<uint32_t>(rule.args.size());
            c.symbols.push_back(symbol);
        }
        Symbol& symbol = c.symbols[found->second];
        if (symbol.argCount != rule.args.size())
            c.reporter.error(rule.place, rule.predecessor,
                             "an earlier rule of this name takes " + std::to_string(symbol.argCount) +
                                 " arguments, this one " + std::to_string(rule.args.size()));
        symbol.rules.push_back(i);
    }
}

// What is so of a symbol is so of all that call it.
void spread(Compilation& c, const std::vector<std::vector<uint32_t>>& callers, bool Symbol::*property, bool value) {
    std::vector<uint32_t> open;
    for (uint32_t s = 0; s < c.symbols.size(); ++s)
        if (c.symbols[s].*property == value) open.push_back(s);
    while (!open.empty()) {
        const uint32_t from = open.back();
        open.pop_back();
        for (uint32_t caller : callers[from])
            if (std::exchange(c.symbols[caller].*property, value) != value) open.push_back(caller);
    }
}

// grows: some rule marches or calls what grows. vanishes: no rule marches, draws or calls what doesn't vanish.
void classify(Compilation& c) {
    std::vector<std::vector<uint32_t>> callers(c.symbols.size());
    for (uint32_t s = 0; s < c.symbols.size(); ++s) {
        Symbol& symbol = c.symbols[s];
        for (uint32_t r : symbol.rules) {
            const Rule& rule = c.module.rules[r];
            if (wholeBlock(rule, Block::marching) != nullptr) {
                symbol.grows = true;
                symbol.vanishes = false;
                continue;
            }
            forEachElement(rule.successor, [&](const Element& e) {
                const uint32_t callee = isCall(e) ? c.findSymbol(e.name) : kNoSymbol;
                if (callee != kNoSymbol) callers[callee].push_back(s);
                const CommandInfo* command = findCommand(e.name);
                if (command != nullptr && command->kind == Command::shape) symbol.vanishes = false;
            });
        }
    }
    spread(c, callers, &Symbol::grows, true);
    spread(c, callers, &Symbol::vanishes, false);
}

// Depth-first over the calls that rules without Marching make.
class CycleCheck {
  public:
    explicit CycleCheck(Compilation& c) : c_(c), state_(c.symbols.size(), 0), height_(c.symbols.size(), 0) {}
    void run() {
        for (uint32_t s = 0; s < c_.symbols.size(); ++s) visit(s);
    }

  private:
    void visit(uint32_t s) {
        if (state_[s] != 0) return;
        state_[s] = 1;
        path_.push_back(s);
        uint32_t below = 0;
        for (uint32_t r : c_.symbols[s].rules) {
            const Rule& rule = c_.module.rules[r];
            if (wholeBlock(rule, Block::marching) != nullptr) continue;
            forEachElement(rule.successor, [&](const Element& e) {
                uint32_t callee = isCall(e) ? c_.findSymbol(e.name) : kNoSymbol;
                if (callee == kNoSymbol) return;
                if (state_[callee] == 1) return reportCycle(rule, e, callee);
                visit(callee);
                below = std::max(below, height_[callee] + 1);
            });
        }
        height_[s] = below;
        const Symbol& symbol = c_.symbols[s];
        if (symbol.grows && height_[s] == kMaxListDepth + 1)
            c_.reporter.error(
                c_.module.rules[symbol.rules[0]].place, symbol.name,
                "too deep nesting: more than " + std::to_string(kMaxListDepth) + " rules in a row without Marching");
        path_.pop_back();
        state_[s] = 2;
    }
    void reportCycle(const Rule& rule, const Element& e, uint32_t callee) {
        std::string cycle;
        auto from = std::find(path_.begin(), path_.end(), callee);
        for (; from != path_.end(); ++from) cycle += c_.symbols[*from].name + " -> ";
        c_.reporter.error(
            e.place, rule.predecessor,
            "endless recursion: " + cycle + e.name + " never marches; a cycle needs a Marching rule in it");
    }
    Compilation& c_;
    std::vector<uint8_t> state_;
    std::vector<uint32_t> height_, path_;
};

void warnUncalled(Compilation& c) {
    for (const Rule& rule : c.module.rules)
        forEachElement(rule.successor, [&](const Element& e) {
            uint32_t callee = c.findSymbol(e.name);
            if (callee != kNoSymbol && e.name != rule.predecessor) c.symbols[callee].called = true;
        });
    for (const Symbol& symbol : c.symbols) {
        const Rule& rule = c.module.rules[symbol.rules[0]];
        if (!symbol.called && !symbol.grows && rule.place.file == 0)
            c.reporter.warning(rule.place, symbol.name,
                               "nothing uses '" + symbol.name + "', and it doesn't grow by itself");
    }
}

}  // namespace

void forEachElement(const Sequence& sequence, const std::function<void(const Element&)>& fn) {
    for (const Element& e : sequence) {
        fn(e);
        for (const Sequence& item : e.items) forEachElement(item, fn);
    }
}

// Here rather than in the lowering, which sees only what is reached.
static void reportUnknownNames(Compilation& c) {
    for (const Rule& rule : c.module.rules)
        forEachElement(rule.successor, [&](const Element& e) {
            if (isCall(e) && c.findSymbol(e.name) == kNoSymbol) c.reportUnknown(e, rule.predecessor);
        });
}

GrammarKind kindOf(const Module& module) {
    bool roofs = false, marches = false, patterns = !module.fields.empty();
    for (const Rule& rule : module.rules)
        forEachElement(rule.successor, [&](const Element& e) {
            const BlockInfo* block = findBlock(e);
            const CommandInfo* command = findCommand(e.name);
            patterns = patterns || (command != nullptr && isOfPatterns(command->kind));
            if (block == nullptr) return;
            patterns = patterns || isOfPatterns(block->kind);
            marches = marches || block->kind == Block::marching;
            roofs = roofs || isRoofBlock(block->kind) || (block->kind == Block::repeat && e.args.size() > 1);
        });
    if (marches) return GrammarKind::plants;
    return roofs ? GrammarKind::roofs : patterns ? GrammarKind::patterns : GrammarKind::plants;
}

void collectSymbols(Compilation& c) {
    collect(c);
    reportUnknownNames(c);
    if (c.symbols.empty() && !c.reporter.failed()) c.reporter.error({0, 1, 1}, {}, "the grammar has no rules");
}

void analyseSymbols(Compilation& c) {
    collectSymbols(c);
    if (c.symbols.empty()) return;
    classify(c);
    bool complete = !c.reporter.failed();
    if (complete) CycleCheck(c).run();
    if (!c.reporter.failed()) warnUncalled(c);
    bool any = false;
    for (Symbol& symbol : c.symbols) {
        if (!symbol.grows) continue;
        any = true;
        symbol.record = static_cast<uint32_t>(c.symbolRecords.size());
        SymbolRecord record = {};
        record.nameHash = nameHash(symbol.name);
        record.argCount = symbol.argCount;
        for (const SymbolRecord& other : c.symbolRecords)
            if (other.nameHash == record.nameHash)
                c.reporter.error(c.module.rules[symbol.rules[0]].place, symbol.name,
                                 "the name has another's hash; take another");
        c.symbolRecords.push_back(record);
    }
    if (!any && !c.reporter.failed())
        c.reporter.error(c.module.rules[0].place, c.module.rules[0].predecessor,
                         "no rule marches, so nothing can grow; a grammar needs a Marching rule");
}

// [symbol]: whether links lead to it from `first`, and `first` itself.
static std::vector<bool> reachedFrom(uint32_t first, const std::vector<std::vector<uint32_t>>& links) {
    std::vector<bool> reached(links.size());
    std::vector<uint32_t> open{first};
    reached[first] = true;
    while (!open.empty()) {
        const uint32_t from = open.back();
        open.pop_back();
        for (uint32_t to : links[from])
            if (!reached[to]) {
                reached[to] = true;
                open.push_back(to);
            }
    }
    return reached;
}

// Plants begin with the first symbol that grows. One that was put above the others, and has nothing to do with them, is
// likely to be a mistake; one that comes to it is another way to begin, for hosts that ask for it. Of others that
// belong together the first is told.
void warnUnreached(Compilation& c) {
    const auto start = std::ranges::find_if(c.symbols, &Symbol::grows);
    if (start == c.symbols.end()) return;
    std::vector<std::vector<uint32_t>> callees(c.symbols.size()), callers(c.symbols.size());
    for (uint32_t i = 0; i < c.symbols.size(); ++i)
        for (uint32_t rule : c.symbols[i].rules)
            forEachElement(c.module.rules[rule].successor, [&](const Element& e) {
                const uint32_t callee = c.findSymbol(e.name);
                if (callee == kNoSymbol) return;
                callees[i].push_back(callee);
                callers[callee].push_back(i);
            });
    const uint32_t first = uint32_t(start - c.symbols.begin());
    const std::vector<bool> after = reachedFrom(first, callees), before = reachedFrom(first, callers);
    std::vector<bool> told = after;
    for (uint32_t i = 0; i < c.symbols.size() && !c.reporter.warnedEnough(); ++i) {
        const Symbol& symbol = c.symbols[i];
        const Rule& rule = c.module.rules[symbol.rules[0]];
        if (!symbol.grows || rule.place.file != 0 || told[i] || before[i]) continue;
        c.reporter.warning(rule.place, symbol.name,
                           "plants begin with '" + start->name + "', the first rule that grows, and never come to '" +
                               symbol.name + "'");
        const std::vector<bool> with = reachedFrom(i, callees);
        for (uint32_t other = 0; other < told.size(); ++other) told[other] = told[other] || with[other];
    }
}

void Compilation::reportUnknown(const Element& e, const std::string& rule) {
    if (reporter.full() || module.mistaken.contains(e.name)) return;
    std::vector<std::string> candidates = successorNames();
    for (const Symbol& s : symbols) candidates.push_back(s.name);
    reporter.error(e.place, rule, "there is no rule for '" + e.name + "'" + didYouMean(e.name, candidates));
}

bool Compilation::checkArgs(const Element& e, const Symbol& symbol, const std::string& rule) {
    if (e.hasItems) {
        reporter.error(e.place, rule, "'" + e.name + "' is a symbol and takes no successors in braces");
        return false;
    }
    if (symbol.argCount > kMaxArgs) return false;  // reported where it is defined
    if (e.args.size() == symbol.argCount) return true;
    reporter.error(e.place, rule,
                   symbol.name + " takes " + std::to_string(symbol.argCount) +
                       (symbol.argCount == 1 ? " argument, not " : " arguments, not ") + std::to_string(e.args.size()));
    return false;
}

Env Compilation::environment(const Rule& rule, uint32_t ordinal, std::span<const Node> args) const {
    Env env;
    env.rule = rule.predecessor;
    for (size_t i = 0; i < rule.args.size() && i < args.size(); ++i) env.args.emplace_back(rule.args[i], args[i]);
    env.sitePrefix = nameHash(rule.predecessor) + ordinal * 0x9E3779B9u;
    return env;
}

bool Compilation::generate(std::span<const Node> roots, StageReads& stageSites, StageReads& reads, CodeRange& range,
                           std::span<Value> values, const Place& place, const std::string& rule) {
    std::string error = code.generate(roots, stageSites, reads, range, values);
    if (!error.empty()) reporter.error(place, rule, error);
    return error.empty();
}

uint32_t Compilation::storeSites(const StageReads& reads) {
    uint32_t first = static_cast<uint32_t>(sites.size());
    sites.insert(sites.end(), reads.sites.begin(), reads.sites.end());
    return first;
}

namespace {

struct Group {
    Node condition;
    std::vector<uint32_t> rules;  // numbers among the symbol's
    std::vector<Node> weights;
};

// The number of the drawn rule: draws are multiples of 2^-24 and so are the thresholds.
Node pick(Compilation& c, const Group& group, const Env& env, uint32_t groupNumber) {
    Graph& g = c.graph;
    Node last = g.constant(static_cast<float>(group.rules.back()));
    if (group.rules.size() == 1) return last;
    Node total = g.zero();
    for (Node w : group.weights) total = g.add(total, w);
    Node draw = Expressions::siteNode(g, env, 0xFFFF0000u + groupNumber);
    Node sum = g.zero();
    std::vector<Node> thresholds;
    for (size_t i = 0; i + 1 < group.rules.size(); ++i) {
        sum = g.add(sum, group.weights[i]);
        Node scaled = g.add(g.mul(g.make(kOpDiv, sum, total), g.constant(16777216.0f)), g.constant(0.5f));
        thresholds.push_back(g.mul(g.make(kOpFloor, scaled), g.constant(5.96046448e-8f)));
    }
    Node result = last;
    for (size_t i = thresholds.size(); i-- > 0;)
        result = g.select(g.make(kOpLess, draw, thresholds[i]), g.constant(static_cast<float>(group.rules[i])), result);
    return result;
}

}  // namespace

Node Compilation::chooseRule(const Symbol& symbol, std::vector<Env>& envs) {
    std::vector<Group> groups;
    for (uint32_t i = 0; i < symbol.rules.size(); ++i) {
        const Rule& rule = module.rules[symbol.rules[i]];
        Node condition =
            rule.condition == kNoExpr ? graph.one() : graph.truth(expressions.lower(rule.condition, envs[i]));
        Node weight = graph.one();
        if (rule.probability != kNoExpr) {
            weight = expressions.lower(rule.probability, envs[i]);
            const Place& place = module.exprs[rule.probability].place;
            if (!graph.isConstant(weight) && !graph[weight].uniform)
                reporter.error(
                    place, symbol.name,
                    "a probability may use numbers and parameters only; for more, write a condition with rand()");
            else if (graph.isConstant(weight) && graph[weight].value < 0)
                reporter.error(place, symbol.name, "a probability can't be negative");
            weight = graph.make(kOpMax, weight, graph.zero());
        }
        auto same =
            std::find_if(groups.begin(), groups.end(), [&](const Group& g) { return g.condition == condition; });
        if (same == groups.end()) same = groups.insert(groups.end(), Group{condition, {}, {}});
        bool certain =
            std::any_of(groups.begin(), same, [&](const Group& g) { return graph.isConstant(g.condition, 1.0f); });
        if (certain && rule.place.file == 0)
            reporter.warning(rule.place, symbol.name,
                             "this rule is never reached: one without condition stands before it");
        same->rules.push_back(i);
        same->weights.push_back(weight);
    }
    Node result = graph.constant(-1.0f);
    for (size_t i = groups.size(); i-- > 0;)
        result = graph.select(groups[i].condition, pick(*this, groups[i], envs[0], static_cast<uint32_t>(i)), result);
    return result;
}

std::vector<Env> Compilation::lowerChoice(const Symbol& symbol, std::span<const Node> args) {
    std::vector<Env> envs;
    for (uint32_t i = 0; i < symbol.rules.size(); ++i)
        envs.push_back(environment(module.rules[symbol.rules[i]], i, args));
    Node chosen = chooseRule(symbol, envs);
    SymbolRecord record = symbolRecords[symbol.record];
    StageReads reads;
    const Rule& first = module.rules[symbol.rules[0]];
    generate({&chosen, 1}, reads, reads, record.select, {&record.selected, 1}, first.place, symbol.name);
    record.firstSite = storeSites(reads);
    record.siteCount = static_cast<uint32_t>(reads.sites.size());
    record.inputs = reads.inputs;
    record.layers = reads.layers;
    record.uses = reads.params;
    record.firstRule = static_cast<uint32_t>(rules.size());
    record.ruleCount = static_cast<uint32_t>(symbol.rules.size());
    symbolRecords[symbol.record] = record;
    rules.resize(rules.size() + symbol.rules.size());
    return envs;
}

}  // namespace espalier::grammar
