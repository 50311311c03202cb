// Expressions -> graph nodes. Everything is lowered to the interpreter's few operations: clamp to min and max, pow
// to products, rand to a draw slot, angleTo to an input that the expander fills.
#include "runtime/grammar/expressions.hpp"

#include <algorithm>

namespace espalier::grammar {
namespace {

constexpr uint64_t kMaxWork = 300'000;
constexpr size_t kMaxLets = 64;  // that use each other in a row
constexpr size_t kMaxNodes = 1'000'000;

}  // namespace

Expressions::Expressions(Module& module, Reporter& reporter, Graph& graph)
    : module_(module), reporter_(reporter), graph_(graph) {}

bool Expressions::withinBudget(const Place& place, const std::string& rule, uint64_t work) {
    if (work_ >= kMaxWork) return false;
    work_ += graph_.size() < kMaxNodes ? work : kMaxWork;
    if (work_ >= kMaxWork)
        reporter_.error(place, rule,
                        "the grammar unfolds into too much; are lets or successors nested in each other many times?");
    return work_ < kMaxWork;
}

Node Expressions::fail(const Place& place, const Env& env, const std::string& message) {
    reporter_.error(place, env.rule, message);
    return graph_.mistake();
}

bool Expressions::mistaken(const std::string& name) const {
    return module_.mistaken.contains(name.substr(0, name.find('.')));
}

Node Expressions::unknown(const std::string& name, const Place& place, const Env& env) {
    if (reporter_.full() || mistaken(name)) return graph_.mistake();
    auto [hint, fresh] = hints_.try_emplace({env.rule, name});
    if (fresh) {
        std::vector<std::string> candidates = roofs() ? roofAccessorNames() : accessorNames();
        for (const auto& arg : env.args) candidates.push_back(arg.first);
        candidates.insert(candidates.end(), names_.begin(), names_.end());
        hint->second = didYouMean(name, candidates);
    }
    return fail(place, env, "'" + name + "' is not known" + hint->second);
}

Node Expressions::accessor(const AccessorInfo& info, const Place& place, const Env& env) {
    std::string name(info.name);
    if (info.where == Where::onSpans && env.where == Where::anywhere)
        return fail(place, env,
                    "'" + name + "' is known only once the branch has grown; use it in extruded successors");
    if (info.where == Where::inRepeat && env.where != Where::inRepeat)
        return fail(place, env, "'" + name + "' has a meaning inside Repeat only");
    return graph_.leaf(Leaf::slot, info.slot);
}

// False: it is reported that the let can't be entered.
bool Expressions::enterLet(const std::string& name, const Place& place, const Env& env) {
    used_.insert(name);
    if (activeLets_.size() >= kMaxLets) return fail(place, env, "more than 64 lets are nested in each other"), false;
    if (activeLets_.insert(name).second) return true;
    return fail(place, env, "'" + name + "' is defined by itself"), false;
}

Node Expressions::failTooDeep(const Place& place, const Env& env) {
    return fail(place, env, "the expression unfolds into more than 256 operations in a row");
}

Node Expressions::sum(Node x, Node y, const Place& place, const Env& env) {
    const Node node = graph_.add(x, y);
    return graph_[node].depth <= kMaxGraph ? node : failTooDeep(place, env);
}

Node Expressions::lowerName(const std::string& name, const Place& place, Env& env) {
    for (const auto& [arg, node] : env.args)
        if (arg == name) return node;
    size_t dot = name.find('.');
    std::string base = name.substr(0, dot);
    std::string part = dot == std::string::npos ? "" : name.substr(dot + 1);
    if (auto found = paramByName_.find(base); found != paramByName_.end()) {
        const ParamInfo& p = params[found->second];
        used_.insert(base);
        if (p.kind != ParamKind::colour && part.empty()) return graph_.leaf(Leaf::param, p.slot);
        size_t channel = part.size() == 1 ? std::string("rgb").find(part) : std::string::npos;
        if (p.kind == ParamKind::colour && channel != std::string::npos)
            return graph_.leaf(Leaf::param, p.slot + static_cast<uint32_t>(channel));
        return fail(place, env,
                    p.kind == ParamKind::colour ? "a colour is read as " + base + ".r, .g or .b, or given to Colour"
                                                : "'" + name + "' has no parts");
    }
    if (auto found = letByName_.find(name); found != letByName_.end()) {
        if (!enterLet(name, place, env)) return graph_.mistake();
        const LetScope scope(env, name);
        Node node = lower(module_.lets[found->second].value, env);
        activeLets_.erase(name);
        return node;
    }
    if (const std::optional<Node> query = fieldQuery(base, part, place, env)) return *query;
    if (name == "pi") return graph_.constant(kPi);
    if (name == "true" || name == "otherwise") return graph_.one();
    if (name == "false") return graph_.zero();
    if (roofs()) {
        if (const AccessorInfo* info = findRoofAccessor(name)) return graph_.leaf(Leaf::slot, info->slot);
        if (const float* word = findRoofWord(name)) return graph_.constant(*word);
        if (findAccessor(name) != nullptr)
            return fail(place, env, "'" + name + "' belongs to growth over a surface; a grammar of roofs has no walk");
        if (findRoofAccessor(name + ".x") != nullptr || (letByName_.count(base) != 0 && !part.empty()))
            return fail(place, env, "'" + name + "' is a vector; here a number is wanted, such as " + base + ".x");
        return unknown(name, place, env);
    }
    if (const AccessorInfo* info = findAccessor(name)) return accessor(*info, place, env);
    const std::string layerName = base == "context" ? name.substr(dot + 1) : name;
    if (contextByName_.count(layerName) != 0 || colourContexts_.count(layerName) != 0) {
        return fail(place, env, "a painted layer is read at a place: write " + layerName + "(texCoord)");
    }
    if (name == "texCoord" || name == "normal" || name == "heading" || name == "position")
        return fail(place, env, "'" + name + "' has parts: write " + name + ".x or " + name + ".y");
    if (findDirection(name) != nullptr)
        return fail(place, env,
                    "'" + name + "' is a direction; it stands in angleTo(" + name + ") or facing(" + name + ")");
    return unknown(name, place, env);
}

Node Expressions::lower(ExprId id, Env& env) {
    // Lets unfold on the way down, so the stack is watched there; the graph may be deeper than the text.
    if (nesting_ < kMaxGraph) {
        ++nesting_;
        Node node = lowerTree(id, env);
        --nesting_;
        if (graph_[node].depth <= kMaxGraph) return node;
    }
    return failTooDeep(module_.exprs[id].place, env);
}

Node Expressions::lowerTree(ExprId id, Env& env) {
    const Expr& e = module_.exprs[id];
    if (!withinBudget(e.place, env.rule)) return graph_.mistake();
    switch (e.kind) {
        case ExprKind::number:
            return graph_.constant(e.value);
        case ExprKind::string:
            return fail(e.place, env, "a text can't be used as a number; texts belong in Shape");
        case ExprKind::name:
            return lowerName(e.text, e.place, env);
        case ExprKind::call:
            return call(e, env);
        case ExprKind::unary: {
            Node x = lower(e.kids[0], env);
            return e.text == "!" ? graph_.negation(x) : graph_.sub(graph_.zero(), x);
        }
        case ExprKind::binary:
            return binary(e, env);
        case ExprKind::choice: {
            Node test = lower(e.kids[0], env);
            Node yes = lower(e.kids[1], env);
            return graph_.select(test, yes, lower(e.kids[2], env));
        }
    }
    return graph_.zero();
}

Node Expressions::binary(const Expr& e, Env& env) {
    Node x = lower(e.kids[0], env);
    Node y = lower(e.kids[1], env);
    Graph& g = graph_;
    if (e.text == "+") return g.add(x, y);
    if (e.text == "-") return g.sub(x, y);
    if (e.text == "*") return g.mul(x, y);
    if (e.text == "/" || e.text == "%") {
        if (g.isConstant(y, 0.0f)) return fail(e.place, env, "division by zero");
        return e.text == "/" ? g.quotient(x, y) : g.remainder(x, y);
    }
    if (e.text == "<") return g.make(kOpLess, x, y);
    if (e.text == ">") return g.make(kOpLess, y, x);
    if (e.text == "<=") return g.make(kOpLessEq, x, y);
    if (e.text == ">=") return g.make(kOpLessEq, y, x);
    if (e.text == "==") return g.make(kOpEqual, x, y);
    if (e.text == "!=") return g.negation(g.make(kOpEqual, x, y));
    if (e.text == "&&") return g.both(x, y);
    return g.either(x, y);
}

}  // namespace espalier::grammar
