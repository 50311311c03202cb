// Grammars of patterns -> symbol, rule, part and command records (Li 2011 §3, §4).
//
// A production is laid out as a row of parts, each with its own chain of scope commands: brackets are gone. A symbol
// that only places one piece, by way of others or by itself, is put in its place, so that what stands behind it in the
// production is culled when the piece meets another (§4.4).
#include <algorithm>

#include "runtime/grammar/compilation.hpp"

namespace espalier::grammar {
namespace {

constexpr uint32_t kMostInlined = 8;  // symbols within each other

class PatternLowering {
  public:
    explicit PatternLowering(Compilation& c) : c_(c), g_(c.graph) {
        for (uint32_t i = 0; i < kMaxArgs; ++i) args_[i] = g_.leaf(Leaf::slot, kSlotArg + i);
    }

    void run() {
        for (Symbol& symbol : c_.symbols) {
            symbol.grows = true;
            symbol.vanishes = false;
            addRecord(symbol);
        }
        for (const Symbol& symbol : c_.symbols) lowerSymbol(symbol);
        const bool places = std::ranges::any_of(c_.parts, [](const PatternPart& p) { return p.kind != kPartSymbol; });
        if (!places && !c_.reporter.failed())
            c_.reporter.error({0, 1, 1}, {}, "no rule places a mesh, so nothing is to be seen; write I(\"mesh\")");
    }

  private:
    struct Step {
        uint32_t kind;
        Node values[3];
        Place place;
    };
    // What stands in front of an element: commands, colour, the set that has to stand.
    struct State {
        std::vector<Step> chain;
        Node colour[3];
        uint32_t begin = kNoIndex;  // steps to where the next segment of a line begins; kNoIndex: there is no line
        bool merges = false;        // segments end at those that they cross
    };
    // The set that an element has tried to place, and what parts waited for before; kNoIndex: none.
    struct Trial {
        uint32_t before = kNoIndex, set = kNoIndex;
    };
    struct Production {
        std::vector<PatternPart> parts;
        uint32_t sets = 0, pieces = 0;
        uint32_t prereq = kNoIndex;
        uint32_t openSet = kNoIndex;  // of the Lock that goes on
        uint32_t inlined = 0;         // symbols put in place so far: each has draws of its own
        std::vector<std::string> within;
    };

    void error(const Place& place, const Env& env, const std::string& message) {
        c_.reporter.error(place, env.rule, message);
    }
    void addRecord(Symbol& symbol) {
        const Place& place = c_.module.rules[symbol.rules[0]].place;
        symbol.record = uint32_t(c_.symbolRecords.size());
        SymbolRecord record = {};
        record.nameHash = nameHash(symbol.name);
        record.argCount = std::min(symbol.argCount, kMaxArgs);
        for (const SymbolRecord& other : c_.symbolRecords)
            if (other.nameHash == record.nameHash)
                c_.reporter.error(place, symbol.name, "the name has another's hash; take another");
        c_.symbolRecords.push_back(record);
    }

    // Of its rules, the highest.
    uint32_t priorityOf(const Symbol& symbol) {
        uint32_t highest = 0;
        for (uint32_t r : symbol.rules) {
            const Rule& rule = c_.module.rules[r];
            if (rule.priority == kNoExpr) continue;
            Env env;
            env.rule = symbol.name;
            const Node n = c_.expressions.lower(rule.priority, env);
            const float value = g_.isConstant(n) ? g_[n].value : -1;
            if (!(value >= 0 && value <= float(kMaxPriority) && value == float(int(value)))) {
                error(c_.module.exprs[rule.priority].place, env, "a priority is a whole number from 0 to 7");
                continue;
            }
            highest = std::max(highest, uint32_t(value));
        }
        return highest;
    }

    void lowerSymbol(const Symbol& symbol) {
        std::vector<Env> envs = c_.lowerChoice(symbol, args_);
        const uint32_t firstRule = c_.symbolRecords[symbol.record].firstRule;
        for (uint32_t i = 0; i < symbol.rules.size(); ++i) {
            const Rule& rule = c_.module.rules[symbol.rules[i]];
            Production production;
            production.within.push_back(symbol.name);
            State state;
            std::fill_n(state.colour, 3, g_.constant(-1));
            walk(rule.successor, envs[i], state, production);
            c_.rules[firstRule + i] = store(production, rule.place, envs[i]);
        }
    }

    RuleRecord store(const Production& production, const Place& place, const Env& env) {
        RuleRecord r = {};
        r.kind = kRulePattern;
        r.distance = r.angle = r.condition = {kSlotImmediate, 0};
        r.firstSuccessor = uint32_t(c_.parts.size());
        r.successorCount = uint32_t(production.parts.size());
        r.extrude = production.sets | production.pieces << 16;
        if (production.parts.size() > kMaxParts)
            error(place, env, "a production of more than 64 symbols and meshes; split it into several rules");
        c_.parts.insert(c_.parts.end(), production.parts.begin(), production.parts.end());
        return r;
    }

    void walk(const Sequence& sequence, Env& env, State& state, Production& production) {
        std::vector<State> kept;
        Trial trial;
        for (const Element& e : sequence) {
            if (!c_.expressions.withinBudget(e.place, env.rule) || c_.reporter.full()) return;
            const CommandInfo* command = findCommand(e.name);
            const BlockInfo* block = findBlock(e.name);
            const Trial last = std::exchange(trial, {production.prereq, kNoIndex});
            if (command != nullptr && command->kind == Command::omit) {
                omit(*command, e, env, last, production);
                continue;
            }
            if (block != nullptr && block->kind == Block::instead) {
                instead(*block, e, env, last, state, production);
                continue;
            }
            if (command != nullptr && command->kind == Command::push) {
                kept.push_back(state);
            } else if (command != nullptr && command->kind == Command::pop) {
                if (kept.empty()) return error(e.place, env, "']' without '['");
                state = kept.back();
                kept.pop_back();
            } else if (command != nullptr) {
                apply(*command, e, env, state, production);
            } else if (block != nullptr) {
                lock(*block, e, env, state, production);
            } else {
                call(e, env, state, production);
            }
            const bool segment = command != nullptr && command->kind == Command::lineSegment;
            if (production.prereq != trial.before && !segment) trial.set = production.prereq;
        }
        if (!kept.empty()) error(sequence.front().place, env, "'[' without ']'");
    }

    void apply(const CommandInfo& info, const Element& e, Env& env, State& state, Production& production) {
        if (info.kind == Command::placeMerged) return merged(info, e, env, state, production);
        if (info.kind == Command::lineSegment) return segment(info, e, env, state, production);
        const bool vector = info.kind == Command::size || info.kind == Command::translate;
        if (info.kind == Command::null) return;
        if (e.hasItems || e.args.size() < 1 || e.args.size() > (vector || info.kind == Command::colour ? 3 : 1))
            return error(e.place, env, vector ? "write " + e.name + "(x, y, z)" : "write " + std::string(info.usage));
        switch (info.kind) {
            case Command::place:
            case Command::placeTested:
                return piece(info.kind == Command::placeTested ? kPartTested : kPartPlaced, e, {}, env, state,
                             production);
            case Command::colour:
                c_.expressions.lowerColour(e.args, e.place, env, state.colour);
                return;
            case Command::size:
                return step(kOpSize, e, env, state);
            case Command::translate:
                return step(kOpTranslate, e, env, state);
            case Command::rotateX:
                return step(kOpRotateX, e, env, state);
            case Command::rotateY:
                return step(kOpRotateY, e, env, state);
            case Command::rotateZ:
            case Command::rotate:
                return step(kOpRotateZ, e, env, state);
            default:
                return error(e.place, env, "'" + e.name + "' has no meaning in a grammar of patterns");
        }
    }

    // One number of S is a size in all directions, two leave the third; T moves by 0 where none is given.
    void step(uint32_t kind, const Element& e, Env& env, State& state) {
        const bool turns = kind == kOpRotateX || kind == kOpRotateY || kind == kOpRotateZ;
        Step s{kind, {g_.zero(), g_.zero(), g_.zero()}, e.place};
        for (size_t i = 0; i < e.args.size(); ++i) {
            s.values[i] = c_.expressions.lower(e.args[i], env);
            if (turns && c_.module.degrees) s.values[i] = g_.mul(s.values[i], g_.constant(kPi / 180));
        }
        if (kind == kOpSize)
            for (size_t i = e.args.size(); i < 3; ++i) s.values[i] = s.values[e.args.size() - 1];
        if (state.chain.size() >= kMaxOps) return error(e.place, env, "more than 64 scope commands in a row");
        state.chain.push_back(s);
    }

    // Li 2011 names files, as "cylinder.obj": the mesh is meant, whatever its file.
    void piece(uint32_t kind, const Element& e, std::vector<Node> measures, Env& env, const State& state,
               Production& production) {
        const Expr& text = c_.module.exprs[e.args[0]];
        if (text.kind != ExprKind::string)
            return error(text.place, env, "a mesh's name between quotes must stand here: " + e.name + "(\"scale\")");
        const std::string name = text.text.substr(0, text.text.rfind('.'));
        const auto& meshes = c_.options.meshesOfPatterns();
        const auto mesh = std::ranges::find(meshes, name, &TerminalMesh::name);
        if (mesh == meshes.end()) {
            std::vector<std::string> all;
            for (const TerminalMesh& m : meshes) all.push_back(m.name);
            return error(text.place, env, "there is no mesh \"" + name + "\"" + didYouMean(name, all));
        }
        const bool opens = production.openSet == kNoIndex;
        PatternPart part = partOf(state, production, e.place, env);
        part.kind = opens ? kind : uint32_t(kPartTested);
        part.mesh = uint32_t(mesh - meshes.begin());
        part.set = opens ? production.sets++ : production.openSet;
        const bool line = kind == kPartLine || kind == kPartMergedLine;
        part.begin = line ? state.begin : kNoIndex;
        measures.insert(measures.begin(), state.colour, state.colour + 3);
        part.argCount = uint32_t(measures.size());
        arguments(part, measures, e.place, env);
        production.pieces += 1;
        production.parts.push_back(part);
        if (opens && kind != kPartPlaced && kind != kPartLine) production.prereq = part.set;
    }

    // A piece that goes into a like one: what stands behind it, or in its braces, is made where it doesn't.
    void merged(const CommandInfo& info, const Element& e, Env& env, const State& state, Production& production) {
        if (e.args.size() != 3 || e.items.size() > 1) return error(e.place, env, "write " + std::string(info.usage));
        if (production.openSet != kNoIndex) return error(e.place, env, "what merges has no place in a Lock");
        Node turn = c_.expressions.lower(e.args[2], env);
        if (c_.module.degrees) turn = g_.mul(turn, g_.constant(kPi / 180));
        piece(kPartMerged, e, {c_.expressions.lower(e.args[1], env), turn}, env, state, production);
        State own = state;
        for (const Sequence& item : e.items) walk(item, env, own, production);
    }

    // From where the line has come to so far to where the scope stands.
    void segment(const CommandInfo& info, const Element& e, Env& env, State& state, Production& production) {
        if (e.args.size() != 2 || e.hasItems || state.begin == kNoIndex)
            return error(e.place, env, "write " + std::string(info.usage));
        if (production.openSet != kNoIndex) return error(e.place, env, "a line has no place in a Lock");
        const auto moves = [](const Step& s) { return s.kind == kOpTranslate; };
        if (std::none_of(state.chain.begin() + state.begin, state.chain.end(), moves))
            return error(e.place, env, "a segment leads along a T in front of it: T(0.1, 0, 0) " + e.name + "(...)");
        piece(state.merges ? kPartMergedLine : kPartLine, e, {c_.expressions.lower(e.args[1], env)}, env, state,
              production);
        state.begin = uint32_t(state.chain.size());
    }

    // Segments between the braces hang on each other; what stands behind them doesn't hang on them.
    void line(const BlockInfo& info, const Element& e, Env& env, const State& state, Production& production) {
        const bool merges = e.args.size() == 1 && c_.module.exprs[e.args[0]].kind == ExprKind::name &&
                            c_.module.exprs[e.args[0]].text == "merge";
        if (e.items.size() != 1 || (!e.args.empty() && !merges) || state.begin != kNoIndex)
            return error(e.place, env, "write " + std::string(info.usage));
        State own = state;
        own.begin = uint32_t(own.chain.size());
        own.merges = merges;
        const uint32_t before = production.prereq;
        walk(e.items[0], env, own, production);
        production.prereq = before;
    }

    void lock(const BlockInfo& info, const Element& e, Env& env, State& state, Production& production) {
        if (info.kind == Block::line) return line(info, e, env, state, production);
        if (info.kind != Block::lock)
            return error(e.place, env,
                         "'" + e.name + "' has no place in a grammar of patterns, which moves by T and places by I");
        if (!e.hasItems || !e.args.empty() || e.items.size() > info.maxItems)
            return error(e.place, env, "write " + std::string(info.usage));
        if (production.openSet != kNoIndex) return error(e.place, env, "a Lock stands within another");
        const uint32_t pieces = production.pieces;
        production.openSet = production.sets++;
        for (const Sequence& item : e.items) {
            State own = state;
            walk(item, env, own, production);
        }
        const uint32_t set = std::exchange(production.openSet, kNoIndex);
        if (production.pieces == pieces) {
            production.sets -= 1;
            return error(e.place, env, "a Lock places at least one mesh");
        }
        if (production.pieces - pieces > kMaxPieces) return error(e.place, env, "a Lock of more than 16 meshes");
        production.prereq = set;
    }

    // What stands behind is made whether or not the piece is.
    void omit(const CommandInfo& info, const Element& e, Env& env, const Trial& last, Production& production) {
        if (last.set == kNoIndex || e.hasItems || !e.args.empty())
            return error(e.place, env, "write " + std::string(info.usage));
        production.prereq = last.before;
    }

    // What is made in a piece's place where it can't stand.
    void instead(const BlockInfo& info, const Element& e, Env& env, const Trial& last, const State& state,
                 Production& production) {
        if (last.set == kNoIndex || !e.hasItems || !e.args.empty() || e.items.size() != 1)
            return error(e.place, env, "write " + std::string(info.usage));
        State own = state;
        production.prereq = last.set | kIfFallen;
        walk(e.items[0], env, own, production);
        production.prereq = last.set;
    }

    // The one rule of a symbol that only places a piece, with at most one symbol or mesh in it.
    const Rule* simpleRule(const Symbol& symbol) const {
        if (symbol.rules.size() != 1) return nullptr;
        const Rule& rule = c_.module.rules[symbol.rules[0]];
        if (rule.condition != kNoExpr || rule.probability != kNoExpr || rule.priority != kNoExpr) return nullptr;
        uint32_t made = 0;
        for (const Element& e : rule.successor) {
            const CommandInfo* command = findCommand(e.name);
            if (findBlock(e.name) != nullptr) return nullptr;
            if (e.hasItems) return nullptr;
            const bool makes = command == nullptr || command->kind == Command::place ||
                               command->kind == Command::placeTested || command->kind == Command::placeMerged;
            made += makes ? 1 : 0;
        }
        return made == 1 ? &rule : nullptr;
    }
    // Whether the symbol leads to one piece by simple rules alone.
    bool isSimple(const Symbol& symbol, uint32_t depth) const {
        const Rule* rule = depth < kMostInlined ? simpleRule(symbol) : nullptr;
        if (rule == nullptr) return false;
        for (const Element& e : rule->successor) {
            if (findCommand(e.name) != nullptr) continue;
            const uint32_t next = c_.findSymbol(e.name);
            return next != kNoSymbol && isSimple(c_.symbols[next], depth + 1);
        }
        return true;
    }

    void call(const Element& e, Env& env, State& state, Production& production) {
        const uint32_t index = c_.findSymbol(e.name);
        if (index == kNoSymbol) return;  // reported
        const Symbol& symbol = c_.symbols[index];
        if (!c_.checkArgs(e, symbol, env.rule)) return;
        std::vector<Node> given;
        for (ExprId arg : e.args) given.push_back(c_.expressions.lower(arg, env));
        if (isSimple(symbol, 0)) return putInPlace(symbol, given, state, production);
        if (production.openSet != kNoIndex)
            return error(e.place, env,
                         "in a Lock, '" + e.name + "' must place one mesh by a rule without condition or choice");
        PatternPart part = partOf(state, production, e.place, env);
        part.kind = kPartSymbol;
        part.symbol = symbol.record;
        part.nameHash = nameHash(symbol.name);
        part.argCount = std::min(symbol.argCount, kMaxArgs);
        part.priority = priorityOf(symbol);
        part.set = kNoIndex;
        for (const PatternPart& before : production.parts)
            part.ordinal += before.kind == kPartSymbol && before.symbol == part.symbol ? 1 : 0;
        arguments(part, given, e.place, env);
        production.parts.push_back(part);
    }

    void putInPlace(const Symbol& symbol, const std::vector<Node>& given, const State& state, Production& production) {
        Env env = c_.environment(c_.module.rules[symbol.rules[0]], 0, given);
        env.sitePrefix ^= ++production.inlined * 0x85EBCA6Bu;
        State own = state;
        own.begin = kNoIndex;
        walk(c_.module.rules[symbol.rules[0]].successor, env, own, production);
    }

    PatternPart partOf(const State& state, const Production& production, const Place& place, const Env& env) {
        PatternPart part = {};
        part.begin = kNoIndex;
        part.prereq = production.prereq;
        part.firstOp = uint32_t(c_.ops.size());
        part.opCount = uint32_t(state.chain.size());
        for (Value& v : part.args) v = {kSlotImmediate, 0};
        for (const Step& s : state.chain) {
            PatternOp op = {};
            op.kind = s.kind;
            StageReads sites, reads;
            c_.generate(s.values, sites, reads, op.code, op.values, place, env.rule);
            op.inputs = reads.inputs;
            op.layers = reads.layers;
            op.firstSite = c_.storeSites(sites);
            op.siteCount = uint32_t(sites.sites.size());
            c_.ops.push_back(op);
        }
        return part;
    }
    void arguments(PatternPart& part, std::span<const Node> nodes, const Place& place, const Env& env) {
        StageReads sites, reads;
        c_.generate(nodes.first(std::min<size_t>(nodes.size(), kPartArgs)), sites, reads, part.code, part.args, place,
                    env.rule);
        part.inputs = reads.inputs;
        part.layers = reads.layers;
        part.firstSite = c_.storeSites(sites);
        part.siteCount = uint32_t(sites.sites.size());
    }

    Compilation& c_;
    Graph& g_;
    Node args_[kMaxArgs];
};

}  // namespace

void lowerPatterns(Compilation& c) {
    if (c.reporter.failed()) return;
    PatternLowering(c).run();
}

}  // namespace espalier::grammar
