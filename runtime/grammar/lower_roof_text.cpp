// What a rule of roofs says by itself: what commands change in a shape, and the numbers of a block.
#include <algorithm>

#include "runtime/grammar/lower_roof.hpp"

namespace espalier::grammar {
namespace {

constexpr float kUnchanged = -1;

bool houseColour(const Compilation& c, const Element& e) {
    return e.args.size() == 1 && c.module.exprs[e.args[0]].text == "houseColour";
}

void addVector(Compilation& c, ExprId arg, Env& env, std::vector<Node>& roots) {
    Node v[3];
    int size = 3;
    c.expressions.lowerVector(arg, env, v, size);
    if (size == 2) std::swap(v[1], v[2]);  // a place in the plan
    roots.insert(roots.end(), v, v + 3);
}
// Join(h, roofPos1, roofPos2) makes the atom's own face, whose chain the structure gives.
void join(Compilation& c, const Element& e, Env& env, RuleRecord& r, std::vector<Node>& roots) {
    roots = {c.expressions.lower(e.args[0], env)};
    auto named = [&](ExprId arg, const char* name) { return c.module.exprs[arg].text == name; };
    if (named(e.args[1], "roofPos1") && named(e.args[2], "roofPos2")) r.extrude = 1;
    addVector(c, e.args[1], env, roots);
    addVector(c, e.args[2], env, roots);
}
void split(Compilation& c, const Element& e, Env& env, RuleRecord& r, std::vector<Node>& roots) {
    const std::string& axis = c.module.exprs[e.args[0]].text;
    if (axis != "X" && axis != "Y") return c.reporter.error(e.place, env.rule, "Split goes along X or Y");
    if (e.args.size() != e.items.size() + 1)
        return c.reporter.error(e.place, env.rule,
                                "Split has " + std::to_string(e.args.size() - 1) + " sizes and " +
                                    std::to_string(e.items.size()) + " parts");
    r.extrude = axis == "Y" ? 1 : 0;
    for (uint32_t i = 0; i < kMaxSplit; ++i) {
        uint32_t mode = 3;
        if (i + 1 < e.args.size()) {
            const Expr& size = c.module.exprs[e.args[i + 1]];
            const bool share = size.kind == ExprKind::call && size.text == "~";
            const bool relative = size.kind == ExprKind::call && size.text == "rel" && size.kids.size() == 1;
            mode = share ? kSplitRest : relative ? kSplitRelative : kSplitAbsolute;
            roots.push_back(c.expressions.lower(share || relative ? size.kids[0] : e.args[i + 1], env));
        } else {
            roots.push_back(c.graph.zero());
        }
        r.extrude |= mode << (1 + 2 * i);
    }
}
void repeatOf(Compilation& c, const Element& e, Env& env, RuleRecord& r, std::vector<Node>& roots) {
    const std::string& axis = c.module.exprs[e.args[0]].text;
    r.extrude = axis == "X" ? kRepeatX : axis == "Y" ? kRepeatY : axis == "XY" ? kRepeatX | kRepeatY : 0u;
    if (r.extrude == 0) c.reporter.error(e.place, env.rule, "Repeat goes along X, Y or XY");
    for (size_t i = 2; i < e.args.size(); ++i) {
        const Expr& word = c.module.exprs[e.args[i]];
        if (word.text == "clip" || word.text == "bond")
            r.extrude |= word.text == "clip" ? kRepeatClip : kRepeatBond | kRepeatClip;
        else if (word.text != "fit")
            c.reporter.error(word.place, env.rule, "cells are repeated fit, clip or bond");
    }
    if (c.expressions.isVector(e.args[1])) {
        Node v[3];
        int size = 2;
        c.expressions.lowerVector(e.args[1], env, v, size);
        roots = {v[0], v[1]};
    } else {
        Node n = c.expressions.lower(e.args[1], env);
        roots = {n, n};
    }
}

}  // namespace

RoofScope plainScope(Graph& g) {
    RoofScope s;
    for (uint32_t i = 0; i < kScopeValues; ++i) s.values[i] = i >= 3 && i < 8 ? g.zero() : g.constant(kUnchanged);
    return s;
}

void applyCommand(Compilation& c, const CommandInfo& info, const Element& e, Env& env, RoofScope& scope) {
    const bool metres = info.kind == Command::size || info.kind == Command::translate;
    if (info.kind == Command::null) return;
    if (isOfPatterns(info.kind))
        return c.reporter.error(e.place, env.rule,
                                "'" + e.name + "' belongs to patterns; a grammar either makes roofs or patterns");
    if (e.hasItems || e.args.size() < info.minArgs || e.args.size() > (metres ? 3 : info.maxArgs))
        return c.reporter.error(e.place, env.rule,
                                metres ? "write " + e.name + "(x), " + e.name + "(x, y) or " + e.name + "(x, y, z)"
                                       : "write " + std::string(info.usage));
    scope.plain = false;
    if (info.kind == Command::colour) {
        Node rgb[3];
        if (houseColour(c, e)) {
            for (uint32_t i = 0; i < 3; ++i) scope.values[9 + i] = c.graph.leaf(Leaf::slot, kSlotHouseColour + i);
        } else if (e.args.size() == 3) {
            for (uint32_t i = 0; i < 3; ++i) scope.values[9 + i] = c.expressions.lower(e.args[i], env);
        } else if (c.expressions.lowerColour(e.args, e.place, env, rgb)) {
            std::copy(rgb, rgb + 3, scope.values + 9);
        }
        return;
    }
    if (info.kind == Command::drop || info.kind == Command::moss) {
        scope.values[info.kind == Command::drop ? 12 : 13] = c.expressions.layerNumber(e.args[0], env);
        return;
    }
    for (size_t i = 0; i < e.args.size(); ++i) {
        Node n = c.expressions.lower(e.args[i], env);
        auto add = [&](Node& to) { to = c.expressions.sum(to, n, e.place, env); };
        switch (info.kind) {
            case Command::size:
                scope.values[i] = n;
                break;
            case Command::translate:
                add(scope.values[3 + i]);
                break;
            case Command::rotate:
                add(scope.values[6 + i]);
                break;
            default:
                scope.values[8] = n;
                break;
        }
    }
}

bool lowerBlock(Compilation& c, const BlockInfo& info, const Element& e, Env& env, RuleRecord& r,
                std::vector<Node>& roots) {
    const bool repeat = info.kind == Block::repeat;
    const size_t least = repeat ? 2 : info.minArgs, most = repeat ? 4 : info.maxArgs;
    if (isOfPatterns(info.kind))
        return c.reporter.error(e.place, env.rule,
                                "'" + e.name + "' belongs to patterns; a grammar either makes roofs or patterns"),
               false;
    if (info.kind == Block::marching || info.kind == Block::branch)
        return c.reporter.error(e.place, env.rule,
                                "'" + e.name + "' walks over a surface; a grammar either walks or makes roofs"),
               false;
    if (!e.hasItems || e.args.size() < least || e.args.size() > most || e.items.size() < info.minItems ||
        e.items.size() > info.maxItems)
        return c.reporter.error(
                   e.place, env.rule,
                   "write " + (repeat ? std::string("Repeat(X, Y or XY, size, fit or clip or bond) {successor}")
                                      : std::string(info.usage))),
               false;
    switch (info.kind) {
        case Block::extrude:
            r.kind = kRuleExtrude;
            roots = {c.expressions.lower(e.args[0], env)};
            break;
        case Block::join:
            r.kind = kRuleJoin;
            join(c, e, env, r, roots);
            break;
        case Block::project:
            r.kind = kRuleProject;
            for (ExprId arg : e.args) addVector(c, arg, env, roots);
            break;
        case Block::explode:
            r.kind = kRuleExplode;
            break;
        case Block::split:
            r.kind = kRuleSplit;
            split(c, e, env, r, roots);
            break;
        default:
            r.kind = kRuleRepeat;
            repeatOf(c, e, env, r, roots);
            break;
    }
    return true;
}

}  // namespace espalier::grammar
