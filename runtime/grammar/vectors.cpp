// Vectors of grammars of roofs -> three nodes each (Buron 2013 §3.2, §3.4: targets and axes are vectors). They live at
// compile time only: the machine knows numbers.
#include <algorithm>

#include "runtime/grammar/expressions.hpp"

namespace espalier::grammar {

bool Expressions::lowerVector(ExprId id, Env& env, Node (&xyz)[3], int& size) {
    const Expr& e = module_.exprs[id];
    for (Node& n : xyz) n = graph_.zero();
    size = 3;
    if (!withinBudget(e.place, env.rule)) return false;
    if (nesting_ < kMaxGraph) {  // as in lower()
        ++nesting_;
        const bool good = vectorTree(e, env, xyz, size);
        --nesting_;
        if (!good || std::ranges::all_of(xyz, [&](Node n) { return graph_[n].depth <= kMaxGraph; })) return good;
    }
    return failTooDeep(e.place, env), false;
}

// Whether an expression is a vector, by its look alone; nested too deeply to tell: no.
bool Expressions::isVector(ExprId id, int depth) const {
    if (depth > 8) return false;
    const Expr& e = module_.exprs[id];
    switch (e.kind) {
        case ExprKind::name:
            if (findRoofAccessor(e.text + ".x") != nullptr || e.text == "globalNormal" || e.text == "globalBinormal")
                return true;
            if (auto let = letByName_.find(e.text); let != letByName_.end())
                return isVector(module_.lets[let->second].value, depth + 1);
            return false;
        case ExprKind::call:
            if (e.text == "vec2" || e.text == "vec3" || e.text == "cross" || e.text == "unit") return true;
            return e.kids.empty() && (findRoofAccessor(e.text + ".x") != nullptr || e.text == "globalNormal" ||
                                      e.text == "globalBinormal");
        case ExprKind::unary:
            return isVector(e.kids[0], depth + 1);
        case ExprKind::binary:
            return isVector(e.kids[0], depth + 1) || isVector(e.kids[1], depth + 1);
        default:
            return false;
    }
}

bool Expressions::vectorTree(const Expr& e, Env& env, Node (&xyz)[3], int& size) {
    auto scaled = [&](ExprId vector, Node factor) {
        if (!lowerVector(vector, env, xyz, size)) return false;
        for (Node& n : xyz) n = graph_.mul(n, factor);
        return true;
    };
    auto refuse = [&] {
        fail(e.place, env,
             "expected a vector: an accessor such as currentPos0(), vec2(x, y), vec3(x, y, z), cross(a, b), unit(a)");
        return false;
    };
    if (e.kind == ExprKind::unary && e.text == "-") return scaled(e.kids[0], graph_.constant(-1));
    if (e.kind == ExprKind::name || (e.kind == ExprKind::call && e.kids.empty())) {
        const std::string& name = e.text;
        if (auto let = letByName_.find(name); e.kind == ExprKind::name && let != letByName_.end()) {
            if (!enterLet(name, e.place, env)) return false;
            const LetScope scope(env, name);
            bool good = lowerVector(module_.lets[let->second].value, env, xyz, size);
            activeLets_.erase(name);
            return good;
        }
        if (name == "globalNormal") {
            xyz[1] = graph_.one();
            return true;
        }
        if (name == "globalBinormal") {  // into the house: up x tangent
            xyz[0] = graph_.leaf(Leaf::slot, kSlotEaveTangent + 2);
            xyz[2] = graph_.sub(graph_.zero(), graph_.leaf(Leaf::slot, kSlotEaveTangent));
            return true;
        }
        const AccessorInfo* first = findRoofAccessor(name + ".x");
        if (first == nullptr) return refuse();
        for (uint32_t i = 0; i < 3; ++i) xyz[i] = graph_.leaf(Leaf::slot, first->slot + i);
        return true;
    }
    if (e.kind == ExprKind::binary && (e.text == "+" || e.text == "-")) {
        Node b[3];
        int other = 3;
        if (!lowerVector(e.kids[0], env, xyz, size) || !lowerVector(e.kids[1], env, b, other)) return false;
        for (int i = 0; i < 3; ++i) xyz[i] = e.text == "+" ? graph_.add(xyz[i], b[i]) : graph_.sub(xyz[i], b[i]);
        return true;
    }
    if (e.kind == ExprKind::binary && (e.text == "*" || e.text == "/")) {
        const bool first = isVector(e.kids[0]);
        if (!first && e.text == "/") return refuse();
        Node factor = lower(e.kids[first ? 1 : 0], env);
        if (e.text == "/") factor = graph_.make(kOpDiv, graph_.one(), factor);
        return scaled(e.kids[first ? 0 : 1], factor);
    }
    return e.kind == ExprKind::call ? vectorCall(e, env, xyz, size) : refuse();
}

bool Expressions::vectorCall(const Expr& e, Env& env, Node (&xyz)[3], int& size) {
    Graph& g = graph_;
    const bool two = e.text == "vec2", three = e.text == "vec3";
    if (two || three) {
        size = two ? 2 : 3;
        if (e.kids.size() != size_t(size))
            return fail(e.place, env, e.text + " takes " + std::to_string(size) + " numbers"), false;
        for (size_t i = 0; i < e.kids.size(); ++i) xyz[i] = lower(e.kids[i], env);
        return true;
    }
    if (e.text == "cross" && e.kids.size() == 2) {
        Node a[3], b[3];
        if (!lowerVector(e.kids[0], env, a, size) || !lowerVector(e.kids[1], env, b, size)) return false;
        for (int i = 0; i < 3; ++i) {
            const int j = (i + 1) % 3, k = (i + 2) % 3;
            xyz[i] = g.sub(g.mul(a[j], b[k]), g.mul(a[k], b[j]));
        }
        size = 3;
        return true;
    }
    if (e.text == "unit" && e.kids.size() == 1) {
        if (!lowerVector(e.kids[0], env, xyz, size)) return false;
        Node square = g.zero();
        for (Node n : xyz) square = g.add(g.mul(n, n), square);
        Node inverse = g.make(kOpDiv, g.one(), g.make(kOpSqrt, square));
        for (Node& n : xyz) n = g.mul(n, inverse);
        return true;
    }
    fail(e.place, env,
         "expected a vector: an accessor such as currentPos0(), vec2(x, y), vec3(x, y, z), cross(a, b), unit(a)");
    return false;
}

}  // namespace espalier::grammar
