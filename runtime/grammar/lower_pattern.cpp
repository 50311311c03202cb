// Grammars of patterns -> symbol, rule, part and command records (Li 2011 §3, §4).
//
// A production is laid out as a row of parts, each with its own chain of scope commands: brackets are gone. A symbol
// that only places one piece, by way of others or by itself, is put in its place, so that what stands behind it in the
// production is culled when the piece meets another (§4.4).
#include "runtime/grammar/lower_pattern.hpp"

#include <algorithm>

namespace espalier::grammar {
namespace {

constexpr uint32_t kMostInlined = 8;  // symbols within each other

}  // namespace

void PatternLowering::run() {
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

void PatternLowering::addRecord(Symbol& symbol) {
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

uint32_t PatternLowering::priorityOf(const Symbol& symbol) {
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

void PatternLowering::lowerSymbol(const Symbol& symbol) {
    std::vector<Env> envs = c_.lowerChoice(symbol, args_);
    const uint32_t firstRule = c_.symbolRecords[symbol.record].firstRule;
    for (uint32_t i = 0; i < symbol.rules.size(); ++i) {
        const Rule& rule = c_.module.rules[symbol.rules[i]];
        Production production;
        State state;
        std::fill_n(state.colour, 3, g_.constant(-1));
        walk(rule.successor, envs[i], state, production);
        c_.rules[firstRule + i] = store(production, rule.place, envs[i]);
    }
}

RuleRecord PatternLowering::store(const Production& production, const Place& place, const Env& env) {
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

void PatternLowering::walk(const Sequence& sequence, Env& env, State& state, Production& production) {
    std::vector<State> kept;
    Trial trial;
    for (const Element& e : sequence) {
        if (!c_.expressions.withinBudget(e.place, env.rule) || c_.reporter.full()) return;
        const CommandInfo* command = findCommand(e.name);
        const BlockInfo* block = findBlock(e);
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

void PatternLowering::apply(const CommandInfo& info, const Element& e, Env& env, State& state, Production& production) {
    if (info.kind == Command::placeMerged) return merged(info, e, env, state, production);
    if (info.kind == Command::lineSegment) return segment(info, e, env, state, production);
    const bool vector = info.kind == Command::size || info.kind == Command::translate;
    if (info.kind == Command::null) return;
    if (e.hasItems || e.args.size() < 1 || e.args.size() > (vector || info.kind == Command::colour ? 3 : 1))
        return error(e.place, env, vector ? "write " + e.name + "(x, y, z)" : "write " + std::string(info.usage));
    switch (info.kind) {
        case Command::place:
        case Command::placeTested:
            return piece(info.kind == Command::placeTested ? kPartTested : kPartPlaced, e, {}, env, state, production);
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

void PatternLowering::step(uint32_t kind, const Element& e, Env& env, State& state) {
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

const Rule* PatternLowering::simpleRule(const Symbol& symbol) const {
    if (symbol.rules.size() != 1) return nullptr;
    const Rule& rule = c_.module.rules[symbol.rules[0]];
    if (rule.condition != kNoExpr || rule.probability != kNoExpr || rule.priority != kNoExpr) return nullptr;
    uint32_t made = 0;
    for (const Element& e : rule.successor) {
        const CommandInfo* command = findCommand(e.name);
        if (findBlock(e) != nullptr) return nullptr;
        if (e.hasItems) return nullptr;
        const bool makes = command == nullptr || command->kind == Command::place ||
                           command->kind == Command::placeTested || command->kind == Command::placeMerged;
        made += makes ? 1 : 0;
    }
    return made == 1 ? &rule : nullptr;
}

bool PatternLowering::isSimple(const Symbol& symbol, uint32_t depth) const {
    const Rule* rule = depth < kMostInlined ? simpleRule(symbol) : nullptr;
    if (rule == nullptr) return false;
    for (const Element& e : rule->successor) {
        if (findCommand(e.name) != nullptr) continue;
        const uint32_t next = c_.findSymbol(e.name);
        return next != kNoSymbol && isSimple(c_.symbols[next], depth + 1);
    }
    return true;
}

void PatternLowering::call(const Element& e, Env& env, State& state, Production& production) {
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

void PatternLowering::putInPlace(const Symbol& symbol, const std::vector<Node>& given, const State& state,
                                 Production& production) {
    Env env = c_.environment(c_.module.rules[symbol.rules[0]], 0, given);
    env.sitePrefix ^= ++production.inlined * 0x85EBCA6Bu;
    State own = state;
    own.begin = kNoIndex;
    walk(c_.module.rules[symbol.rules[0]].successor, env, own, production);
}

void lowerPatterns(Compilation& c) {
    if (c.reporter.failed()) return;
    PatternLowering(c).run();
}

}  // namespace espalier::grammar
