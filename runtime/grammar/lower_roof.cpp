// Grammars of roofs -> symbol, rule and successor records (Buron 2013 §3, §4).
//
// A rule replaces a shape by the shapes of one block (Extrude, Join, Project, Explode, Split, Repeat), by a list of
// symbols, or by a terminal. What stands nested - blocks in braces, commands before a symbol, several shapes in a row -
// becomes rules of symbols without a name of their own, so that the expander knows flat rules only. Such a symbol takes
// its rule's arguments over.
#include <algorithm>
#include <deque>

#include "runtime/grammar/lower_roof.hpp"

namespace espalier::grammar {
namespace {

constexpr size_t kMaxSymbols = 4000;

class RoofLowering {
  public:
    explicit RoofLowering(Compilation& c) : c_(c), g_(c.graph) {
        for (uint32_t i = 0; i < kMaxArgs; ++i) args_[i] = g_.leaf(Leaf::slot, kSlotArg + i);
    }

    void run() {
        for (Symbol& symbol : c_.symbols) {
            symbol.grows = true;
            symbol.vanishes = false;
            symbol.record = addRecord(symbol.name, symbol.argCount, c_.module.rules[symbol.rules[0]].place);
        }
        for (const Symbol& symbol : c_.symbols) lowerSymbol(symbol);
        while (!pending_.empty() && !c_.reporter.full()) {
            Nested next = std::move(pending_.front());
            pending_.pop_front();
            lowerNested(next);
        }
        if (!c_.reporter.failed()) {  // a rule with a mistake lacks its numbers
            markGrids(c_);
            markTerminals(c_);
        }
        const uint32_t house = c_.findSymbol("House");
        if (!c_.symbols.empty()) c_.startSymbol = house != kNoSymbol ? c_.symbols[house].record : 0;
    }

  private:
    // A successor that has no name in the text.
    struct Nested {
        uint32_t record;
        std::string name;
        const Rule* rule;
        Sequence sequence;
        Env env;
    };
    struct Target {
        uint32_t symbol;                // record
        const Element* call = nullptr;  // null: nested, arguments are handed on
    };

    void error(const Place& place, const Env& env, const std::string& message) {
        c_.reporter.error(place, env.rule, message);
    }
    uint32_t addRecord(const std::string& name, uint32_t argCount, const Place& place) {
        SymbolRecord record = {};
        record.nameHash = nameHash(name);
        record.argCount = std::min(argCount, kMaxArgs);
        for (const SymbolRecord& other : c_.symbolRecords)
            if (other.nameHash == record.nameHash)
                c_.reporter.error(place, name, "the name has another's hash; take another");
        c_.symbolRecords.push_back(record);
        return static_cast<uint32_t>(c_.symbolRecords.size() - 1);
    }

    void lowerSymbol(const Symbol& symbol) {
        std::vector<Env> envs = c_.lowerChoice(symbol, args_);
        const uint32_t firstRule = c_.symbolRecords[symbol.record].firstRule;
        for (uint32_t i = 0; i < symbol.rules.size(); ++i) {
            const Rule& rule = c_.module.rules[symbol.rules[i]];
            // What is nested in a further rule of the symbol has names of its own.
            const std::string name = i == 0 ? symbol.name : symbol.name + "#" + std::to_string(i) + "r";
            c_.rules[firstRule + i] = lowerSequence(rule.successor, envs[i], rule, name);
        }
    }
    void lowerNested(Nested& nested) {
        SymbolRecord record = c_.symbolRecords[nested.record];
        record.selected = {kSlotImmediate, 0};
        record.firstRule = static_cast<uint32_t>(c_.rules.size());
        record.ruleCount = 1;
        c_.symbolRecords[nested.record] = record;
        c_.rules.emplace_back();
        c_.rules[record.firstRule] = lowerSequence(nested.sequence, nested.env, *nested.rule, nested.name);
    }
    Target nest(Sequence sequence, const Env& env, const Rule& rule, const std::string& name, uint32_t number) {
        if (c_.symbolRecords.size() >= kMaxSymbols) {
            error(rule.place, env, "the grammar unfolds into more than 4,000 shapes");
            return {0};
        }
        std::string own = name + "#" + std::to_string(number);
        c_.nestedNames.push_back(own);
        Nested nested{addRecord(own, static_cast<uint32_t>(rule.args.size()), rule.place), own, &rule,
                      std::move(sequence), env};
        nested.env.sitePrefix = nameHash(own);
        nested.env.nextSite = 0;
        pending_.push_back(std::move(nested));
        return {pending_.back().record};
    }

    bool bracketsMatch(const Sequence& sequence, const Env& env) {
        size_t open = 0;
        for (const Element& e : sequence) {
            const CommandInfo* command = findCommand(e.name);
            if (command != nullptr && command->kind == Command::push) ++open;
            if (command == nullptr || command->kind != Command::pop) continue;
            if (open == 0) return error(e.place, env, "']' without '['"), false;
            --open;
        }
        if (open > 0) error(sequence.front().place, env, "'[' without ']'");
        return open == 0;
    }

    // Commands, then what they lead to. One block, symbol or terminal alone is the rule itself.
    RuleRecord lowerSequence(const Sequence& sequence, Env& env, const Rule& rule, const std::string& name) {
        if (!bracketsMatch(sequence, env)) return emptyRule(kRuleNull);
        size_t made = 0;
        for (const Element& e : sequence) {
            const CommandInfo* command = findCommand(e.name);
            made += command == nullptr || command->kind == Command::shape ? 1 : 0;
            if (command != nullptr && isOfPatterns(command->kind))
                error(e.place, env, "'" + e.name + "' belongs to patterns; a grammar either makes roofs or patterns");
        }
        if (made == 0) return emptyRule(kRuleNull);
        if (made == 1) return single(sequence, env, rule, name);
        // Several: a list, of which each that isn't a plain symbol is a rule of its own behind the commands so far.
        std::vector<Target> all;
        Sequence before;
        std::vector<Sequence> kept;
        uint32_t number = 0;
        for (const Element& e : sequence) {
            const CommandInfo* command = findCommand(e.name);
            if (command != nullptr && command->kind == Command::push) {
                kept.push_back(before);
            } else if (command != nullptr && command->kind == Command::pop) {
                before = kept.back();
                kept.pop_back();
            } else if (command != nullptr && command->kind == Command::null) {
                continue;
            } else if (command != nullptr && command->kind != Command::shape) {
                before.push_back(e);
            } else if (before.empty() && command == nullptr && findBlock(e) == nullptr) {
                if (callee(e, env) != kNoSymbol) all.push_back({c_.symbols[callee(e, env)].record, &e});
            } else {
                Sequence own = before;
                own.push_back(e);
                all.push_back(nest(std::move(own), env, rule, name, number++));
            }
        }
        RuleRecord r = emptyRule(kRuleList);
        StageReads sites, reads;
        addSuccessors(r, {all}, env, sites, reads, sequence.front().place);
        return finish(r, sites, reads);
    }

    RuleRecord single(const Sequence& sequence, Env& env, const Rule& rule, const std::string& name) {
        RoofScope scope = plainScope(g_);
        std::vector<RoofScope> kept;
        const Element* made = nullptr;
        for (const Element& e : sequence) {
            const CommandInfo* command = findCommand(e.name);
            if (command == nullptr || command->kind == Command::shape) {
                made = &e;
            } else if (made != nullptr) {
                if (command->kind != Command::pop && command->kind != Command::null)
                    error(e.place, env, "'" + e.name + "' stands behind what it should change; put it in front");
            } else if (command->kind == Command::push) {
                kept.push_back(scope);
            } else if (command->kind == Command::pop) {
                scope = kept.back();
                kept.pop_back();
            } else {
                applyCommand(c_, *command, e, env, scope);
            }
        }
        if (findCommand(made->name) != nullptr) return terminal(*made, env, scope);
        const BlockInfo* info = findBlock(*made);
        if (scope.plain && info != nullptr) return block(*info, *made, env, rule, name);
        std::vector<Target> to;
        if (info != nullptr)
            to.push_back(nest({*made}, env, rule, name, 99));
        else if (callee(*made, env) != kNoSymbol)
            to.push_back({c_.symbols[callee(*made, env)].record, made});
        RuleRecord r = emptyRule(scope.plain ? kRuleList : kRuleScope);
        StageReads sites, reads;
        std::vector<Node> roots;
        if (!scope.plain) roots.assign(scope.values, scope.values + kScopeValues);
        addValues(r, roots, sites, reads, made->place, env);
        addSuccessors(r, {to}, env, sites, reads, made->place);
        return finish(r, sites, reads);
    }

    RuleRecord terminal(const Element& e, Env& env, const RoofScope& scope) {
        RuleRecord r = emptyRule(kRuleShape);
        const Expr& text = c_.module.exprs[e.args.empty() ? 0 : e.args[0]];
        if (e.args.size() != 1 || text.kind != ExprKind::string || e.hasItems)
            return error(e.place, env, "a terminal of a roof is a mesh's name between quotes: Shape(\"slate\")"), r;
        const auto& meshes = c_.options.meshesOfRoofs();
        auto mesh =
            std::find_if(meshes.begin(), meshes.end(), [&](const TerminalMesh& m) { return m.name == text.text; });
        if (mesh == meshes.end()) {
            std::vector<std::string> all;
            for (const TerminalMesh& m : meshes) all.push_back(m.name);
            return error(text.place, env, "there is no mesh \"" + text.text + "\"" + didYouMean(text.text, all)), r;
        }
        r.extrude = static_cast<uint32_t>(mesh - meshes.begin());
        StageReads sites, reads;
        addValues(r, {scope.values, scope.values + kScopeValues}, sites, reads, e.place, env);
        return finish(r, sites, reads);
    }

    RuleRecord block(const BlockInfo& info, const Element& e, Env& env, const Rule& rule, const std::string& name) {
        RuleRecord r = emptyRule(kRuleNull);
        std::vector<Node> roots;
        if (!lowerBlock(c_, info, e, env, r, roots)) return r;
        StageReads sites, reads;
        addValues(r, roots, sites, reads, e.place, env);
        std::vector<std::vector<Target>> parts;
        for (uint32_t i = 0; i < e.items.size(); ++i) parts.push_back(targets(e.items[i], env, rule, name, i));
        addSuccessors(r, parts, env, sites, reads, e.place);
        return finish(r, sites, reads);
    }
    // A part's successors: symbols, or one rule of its own for anything else.
    std::vector<Target> targets(const Sequence& item, Env& env, const Rule& rule, const std::string& name,
                                uint32_t part) {
        std::vector<Target> all;
        bool plain = true;
        for (const Element& e : item) {
            const CommandInfo* command = findCommand(e.name);
            plain = plain && findBlock(e) == nullptr && (command == nullptr || command->kind == Command::null);
        }
        if (!plain) return {nest(item, env, rule, name, 100 + part)};
        for (const Element& e : item)
            if (findCommand(e.name) == nullptr && callee(e, env) != kNoSymbol)
                all.push_back({c_.symbols[callee(e, env)].record, &e});
        return all;
    }

    uint32_t callee(const Element& e, const Env& env) {
        uint32_t symbol = c_.findSymbol(e.name);
        if (symbol == kNoSymbol) return kNoSymbol;  // reported
        return c_.checkArgs(e, c_.symbols[symbol], env.rule) ? symbol : kNoSymbol;
    }
    static RuleRecord emptyRule(uint32_t kind) {
        RuleRecord r = {};
        r.kind = kind;
        r.distance = r.angle = r.condition = {kSlotImmediate, 0};
        return r;
    }
    // All numbers of a rule are worked out by one stretch of code, its values and its successors' arguments.
    void addValues(RuleRecord& r, const std::vector<Node>& roots, StageReads& sites, StageReads& reads,
                   const Place& place, const Env& env) {
        r.values = static_cast<uint32_t>(c_.roofValues.size());
        c_.roofValues.resize(c_.roofValues.size() + roots.size());
        c_.generate(roots, sites, reads, r.start, {c_.roofValues.data() + r.values, roots.size()}, place, env.rule);
    }
    void addSuccessors(RuleRecord& r, const std::vector<std::vector<Target>>& parts, Env& env, StageReads& sites,
                       StageReads& reads, const Place& place) {
        r.firstSuccessor = static_cast<uint32_t>(c_.successors.size());
        std::vector<uint32_t> seen;
        for (uint32_t part = 0; part < parts.size(); ++part) {
            // A joint's number tells it apart: its draws stay where it is no longer level.
            if (r.kind == kRuleExplode) seen.clear();
            for (const Target& to : parts[part]) {
                SuccessorRecord s = {};
                s.symbol = to.symbol;
                s.nameHash = c_.symbolRecords[to.symbol].nameHash;
                s.argCount = c_.symbolRecords[to.symbol].argCount;
                s.ordinal = static_cast<uint32_t>(std::count(seen.begin(), seen.end(), to.symbol));
                s.part = part;
                seen.push_back(to.symbol);
                std::vector<Node> nodes;
                for (uint32_t i = 0; i < s.argCount; ++i)
                    nodes.push_back(to.call != nullptr ? c_.expressions.lower(to.call->args[i], env) : args_[i]);
                for (Value& v : s.args) v = {kSlotImmediate, 0};
                c_.generate(nodes, sites, reads, s.code, {s.args, nodes.size()}, place, env.rule);
                c_.successors.push_back(s);
            }
        }
        r.successorCount = static_cast<uint32_t>(c_.successors.size()) - r.firstSuccessor;
        if (r.successorCount > kMaxSuccessors) error(place, env, "too many successors: 16 are the most");
    }
    RuleRecord finish(RuleRecord r, const StageReads& sites, const StageReads& reads) {
        r.startInputs = reads.inputs;
        r.startLayers = reads.layers;
        r.params = reads.params;
        r.firstSite = c_.storeSites(sites);
        r.siteCount = static_cast<uint32_t>(sites.sites.size());
        return r;
    }

    Compilation& c_;
    Graph& g_;
    Node args_[kMaxArgs];
    std::deque<Nested> pending_;
};

}  // namespace

void lowerRoofs(Compilation& c) {
    if (c.reporter.failed()) return;
    RoofLowering(c).run();
}

}  // namespace espalier::grammar
