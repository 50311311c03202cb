// Extruded successors -> extrude programs. What draws is unfolded at compile time: calls are replaced by their
// rules, conditions and choices become gates, so that a program is a flat list of terminals and the second pass
// (Buron 2015 §6) needs no derivation.
#include <algorithm>

#include "runtime/grammar/compilation.hpp"

namespace espalier::grammar {
namespace {

constexpr uint32_t kMaxTerminals = 32, kMaxInlining = 16;

// The scope that commands change; CGA's [ and ] keep and restore it.
struct Scope {
    Node size = Graph::kNone, t, lift, turn, pitch, tint;
    Node colour[3];
};

struct Drawn {
    TerminalRecord record = {};
    Node count, gate;
    Scope scope;
    Place place;
    std::string rule;
};

class ExtrudeLowering {
  public:
    explicit ExtrudeLowering(Compilation& c) : c_(c), g_(c.graph) {}

    uint32_t run(const Rule& rule, uint32_t ordinal, const Sequence& extruded, std::span<const Node> args) {
        Env env = c_.environment(rule, ordinal, args);
        env.where = Where::onSpans;
        env.sitePrefix ^= 0x45585452u;  // the rule's growth draws its own numbers
        Scope scope;
        scope.lift = scope.turn = scope.pitch = g_.zero();
        scope.t = g_.constant(0.5f);
        scope.tint = g_.constant(0.4f);  // neither old nor young
        for (Node& n : scope.colour) n = g_.one();
        repeat_ = Graph::kNone;
        walk(extruded, env, g_.one(), scope, 0);
        if (drawn_.empty() || c_.reporter.failed()) return 0;
        std::stable_partition(drawn_.begin(), drawn_.end(),
                              [](const Drawn& d) { return (d.record.flags & kTerminalBark) != 0; });
        return finish(rule, extruded);
    }

  private:
    void error(const Place& place, const Env& env, const std::string& message) {
        c_.reporter.error(place, env.rule, message);
    }

    void walk(const Sequence& sequence, Env& env, Node gate, Scope& scope, uint32_t depth) {
        std::vector<Scope> kept;
        for (const Element& e : sequence) {
            if (!c_.expressions.withinBudget(e.place, env.rule)) return;
            const CommandInfo* command = findCommand(e.name);
            if (command != nullptr && command->kind == Command::push) {
                kept.push_back(scope);
            } else if (command != nullptr && command->kind == Command::pop) {
                if (kept.empty()) return error(e.place, env, "']' without '['");
                scope = kept.back();
                kept.pop_back();
            } else if (command != nullptr) {
                apply(*command, e, env, gate, scope);
            } else if (const BlockInfo* block = findBlock(e)) {
                unfoldBlock(*block, e, env, gate, scope, depth);
            } else {
                call(e, env, gate, scope, depth);
            }
        }
        if (!kept.empty()) error(sequence.front().place, env, "'[' without ']'");
    }

    void apply(const CommandInfo& info, const Element& e, Env& env, Node gate, Scope& scope) {
        if (e.args.size() < info.minArgs || e.args.size() > info.maxArgs || e.hasItems)
            return error(e.place, env, "write " + std::string(info.usage));
        if (info.kind == Command::shape) return shape(e, env, gate, scope);
        if (info.kind == Command::colour) {
            c_.expressions.lowerColour(e.args, e.place, env, scope.colour);
            return;
        }
        if (isOfPatterns(info.kind))
            return error(e.place, env,
                         "'" + e.name + "' belongs to patterns; a grammar either marches or makes patterns");
        if (info.kind == Command::drop || info.kind == Command::moss)
            return error(e.place, env, "'" + e.name + "' belongs to roofs; here layers are read as name(texCoord)");
        Node a[2] = {};
        for (size_t i = 0; i < e.args.size(); ++i) a[i] = c_.expressions.lower(e.args[i], env);
        bool two = e.args.size() == 2;
        auto add = [&](Node& to, Node n) { to = c_.expressions.sum(to, n, e.place, env); };
        switch (info.kind) {
            case Command::size:
                scope.size = a[0];
                break;
            case Command::translate:
                scope.t = a[0];
                if (two) add(scope.lift, a[1]);
                break;
            case Command::rotate:
                add(scope.turn, a[0]);
                if (two) add(scope.pitch, a[1]);
                break;
            case Command::tint:
                scope.tint = a[0];
                break;
            default:
                break;
        }
    }

    void shape(const Element& e, Env& env, Node gate, const Scope& scope) {
        const Expr& text = c_.module.exprs[e.args[0]];
        if (text.kind != ExprKind::string)
            return error(text.place, env, "Shape's mesh is a name between quotes: Shape(\"leaf\")");
        const auto& meshes = c_.options.meshes;
        auto mesh =
            std::find_if(meshes.begin(), meshes.end(), [&](const TerminalMesh& m) { return m.name == text.text; });
        if (mesh == meshes.end()) {
            std::vector<std::string> names;
            for (const TerminalMesh& m : meshes) names.push_back(m.name);
            return error(text.place, env, "there is no mesh \"" + text.text + "\"" + didYouMean(text.text, names));
        }
        uint32_t smoothness = mesh->bark ? kSmoothC1 : kSmoothNone;
        if (e.args.size() == 2) {
            const Expr& word = c_.module.exprs[e.args[1]];
            if (word.text == "discontinuous")
                smoothness = kSmoothNone;
            else if (word.text == "C0")
                smoothness = kSmoothC0;
            else if (word.text == "C1")
                smoothness = kSmoothC1;
            else
                return error(word.place, env, "a shape is discontinuous, C0 or C1");
        }
        if (scope.size == Graph::kNone) return error(e.place, env, "the shape has no size; write S(width) before it");
        if (mesh->bark && env.where == Where::inRepeat)
            return error(e.place, env, "a span has one bark; it can't stand in Repeat");
        if (drawn_.size() >= kMaxTerminals) return error(e.place, env, "more than 32 shapes on one span");
        Drawn d;
        d.record.mesh = static_cast<uint32_t>(mesh - meshes.begin());
        d.record.smoothness = smoothness;
        d.record.flags = mesh->bark ? kTerminalBark : 0u;
        d.record.site =
            static_cast<uint32_t>(mix64((uint64_t(env.sitePrefix) << 32) | (0xFFFE0000u + env.nextSite++))) &
            0x7FFFFFFFu;
        bool inRepeat = env.where == Where::inRepeat;
        d.count = inRepeat ? g_.select(repeatGate_, repeat_, g_.zero()) : g_.truth(gate);
        d.gate = inRepeat ? gate : g_.one();
        d.scope = scope;
        d.place = e.place;
        d.rule = env.rule;
        if (g_.isConstant(d.count) && g_[d.count].value < 1) return;  // never drawn
        drawn_.push_back(d);
    }

    void unfoldBlock(const BlockInfo& block, const Element& e, Env& env, Node gate, Scope& scope, uint32_t depth) {
        if (block.kind == Block::marching)
            return error(e.place, env,
                         "an extruded successor draws on its span and can't march; branches begin in a Branch rule");
        if (isOfPatterns(block.kind))
            return error(e.place, env,
                         "'" + e.name + "' belongs to patterns; a grammar either marches or makes patterns");
        if (isRoofBlock(block.kind))
            return error(e.place, env, "'" + e.name + "' makes roofs; a grammar either marches or makes roofs");
        if (!e.hasItems || e.args.size() < block.minArgs || e.args.size() > block.maxArgs ||
            e.items.size() > block.maxItems)
            return error(e.place, env, "write " + std::string(block.usage));
        if (block.kind == Block::branch) {
            for (const Sequence& item : e.items) {
                Scope own = scope;
                walk(item, env, gate, own, depth);
            }
            return;
        }
        if (env.where == Where::inRepeat) return error(e.place, env, "Repeat in Repeat isn't possible on a span");
        repeat_ = c_.expressions.lower(e.args[0], env);
        repeatGate_ = gate;
        env.where = Where::inRepeat;
        Scope own = scope;
        walk(e.items[0], env, g_.one(), own, depth);
        env.where = Where::onSpans;
    }

    void call(const Element& e, Env& env, Node gate, const Scope& scope, uint32_t depth) {
        uint32_t callee = c_.findSymbol(e.name);
        if (callee == kNoSymbol) return;  // reported
        const Symbol& symbol = c_.symbols[callee];
        if (!c_.checkArgs(e, symbol, env.rule)) return;
        if (symbol.grows)
            return error(
                e.place, env,
                "'" + e.name +
                    "' reaches Marching, but an extruded successor draws on its span; branches begin in a Branch rule");
        // A cycle has been reported by the analysis; here it must only end.
        if (depth >= kMaxInlining)
            return error(e.place, env, "too deep nesting: more than 16 rules draw through each other");
        std::vector<Node> args;
        for (ExprId arg : e.args) args.push_back(c_.expressions.lower(arg, env));
        uint32_t callSite = env.nextSite++;
        std::vector<Env> envs;
        for (uint32_t i = 0; i < symbol.rules.size(); ++i) {
            Env inner = c_.environment(c_.module.rules[symbol.rules[i]], i, args);
            inner.where = env.where;
            inner.sitePrefix =
                static_cast<uint32_t>(combineKeys(inner.sitePrefix, (uint64_t(env.sitePrefix) << 32) | callSite));
            envs.push_back(std::move(inner));
        }
        Node chosen = c_.chooseRule(symbol, envs);
        for (uint32_t i = 0; i < symbol.rules.size(); ++i) {
            // That the choice is rule i is asked of each of its alternatives.
            if (!c_.expressions.withinBudget(e.place, env.rule, symbol.rules.size())) return;
            Node mine = g_.make(kOpEqual, chosen, g_.constant(static_cast<float>(i)));
            Node inner = g_.both(gate, mine);
            if (g_.isConstant(inner, 0.0f)) continue;
            Scope own = scope;
            walk(c_.module.rules[symbol.rules[i]].successor, envs[i], inner, own, depth + 1);
        }
    }

    uint32_t finish(const Rule& rule, const Sequence& extruded) {
        if (c_.extrudes.size() >= kMaxExtrudes) {
            c_.reporter.error(rule.place, rule.predecessor, "more than 255 Marching rules draw something");
            return 0;
        }
        ExtrudeRecord program = {};
        program.nameHash = nameHash(extruded.size() == 1 ? extruded[0].name : rule.predecessor);
        program.firstTerminal = static_cast<uint32_t>(c_.terminals.size());
        program.terminalCount = static_cast<uint32_t>(drawn_.size());
        for (Drawn& d : drawn_) terminal(d, program);
        c_.extrudes.push_back(program);
        return static_cast<uint32_t>(c_.extrudes.size());
    }
    void terminal(Drawn& d, ExtrudeRecord& program) {
        bool bark = (d.record.flags & kTerminalBark) != 0;
        StageReads gate, body;
        c_.generate({&d.count, 1}, gate, gate, d.record.gate, {&d.record.count, 1}, d.place, d.rule);
        Node size = bark ? g_.mul(d.scope.size, g_.constant(0.5f)) : d.scope.size;
        // What a choice within Repeat leaves out has no size. Bark has its material's colour.
        Node roots[9] = {
            g_.select(d.gate, size, g_.zero()), d.scope.t, d.scope.lift, d.scope.turn, d.scope.pitch, d.scope.tint};
        for (uint32_t i = 0; i < 3; ++i) roots[6 + i] = bark ? g_.one() : d.scope.colour[i];
        Value values[9];
        c_.generate(roots, body, body, d.record.body, values, d.place, d.rule);
        TerminalRecord& r = d.record;
        r.size = values[0];
        r.t = values[1];
        r.lift = values[2];
        r.turn = values[3];
        r.pitch = values[4];
        r.tint = values[5];
        std::copy(values + 6, values + 9, r.colour);
        r.gateFirstSite = c_.storeSites(gate);
        r.gateSiteCount = static_cast<uint32_t>(gate.sites.size());
        r.bodyFirstSite = c_.storeSites(body);
        r.bodySiteCount = static_cast<uint32_t>(body.sites.size());
        program.inputs |= gate.inputs | body.inputs;
        program.layers |= gate.layers | body.layers;
        program.params |= gate.params | body.params;
        program.argMask |= gate.args | body.args;
        c_.terminals.push_back(r);
    }

    Compilation& c_;
    Graph& g_;
    std::vector<Drawn> drawn_;
    Node repeat_ = Graph::kNone, repeatGate_ = Graph::kNone;
};

}  // namespace

uint32_t lowerExtrude(Compilation& c, const Rule& rule, uint32_t ordinal, const Sequence& extruded,
                      std::span<const Node> args) {
    return ExtrudeLowering(c).run(rule, ordinal, extruded, args);
}

}  // namespace espalier::grammar
