// What places pieces in grammars of patterns: I, IC, IM, Lock, lines, and what `else` and `omit` say of them -> parts
// and the sets that they hang on.
#include <algorithm>

#include "runtime/grammar/lower_pattern.hpp"

namespace espalier::grammar {

void PatternLowering::piece(uint32_t kind, const Element& e, std::vector<Node> measures, Env& env, const State& state,
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

void PatternLowering::merged(const CommandInfo& info, const Element& e, Env& env, const State& state,
                             Production& production) {
    if (e.args.size() != 3 || e.items.size() > 1) return error(e.place, env, "write " + std::string(info.usage));
    if (production.openSet != kNoIndex) return error(e.place, env, "what merges has no place in a Lock");
    Node turn = c_.expressions.lower(e.args[2], env);
    if (c_.module.degrees) turn = g_.mul(turn, g_.constant(kPi / 180));
    piece(kPartMerged, e, {c_.expressions.lower(e.args[1], env), turn}, env, state, production);
    State own = state;
    for (const Sequence& item : e.items) walk(item, env, own, production);
}

void PatternLowering::segment(const CommandInfo& info, const Element& e, Env& env, State& state,
                              Production& production) {
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

void PatternLowering::line(const BlockInfo& info, const Element& e, Env& env, const State& state,
                           Production& production) {
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

void PatternLowering::lock(const BlockInfo& info, const Element& e, Env& env, State& state, Production& production) {
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

void PatternLowering::omit(const CommandInfo& info, const Element& e, Env& env, const Trial& last,
                           Production& production) {
    if (last.set == kNoIndex || e.hasItems || !e.args.empty())
        return error(e.place, env, "write " + std::string(info.usage));
    production.prereq = last.before;
}

void PatternLowering::instead(const BlockInfo& info, const Element& e, Env& env, const Trial& last, const State& state,
                              Production& production) {
    if (last.set == kNoIndex || !e.hasItems || !e.args.empty() || e.items.size() != 1)
        return error(e.place, env, "write " + std::string(info.usage));
    State own = state;
    production.prereq = last.set | kIfFallen;
    walk(e.items[0], env, own, production);
    production.prereq = last.set;
}

PatternPart PatternLowering::partOf(const State& state, const Production& production, const Place& place,
                                    const Env& env) {
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

void PatternLowering::arguments(PatternPart& part, std::span<const Node> nodes, const Place& place, const Env& env) {
    StageReads sites, reads;
    c_.generate(nodes.first(std::min<size_t>(nodes.size(), kPartArgs)), sites, reads, part.code, part.args, place,
                env.rule);
    part.inputs = reads.inputs;
    part.layers = reads.layers;
    part.firstSite = c_.storeSites(sites);
    part.siteCount = uint32_t(sites.sites.size());
}

}  // namespace espalier::grammar
