// Expressions -> graph nodes. Everything is lowered to the interpreter's few operations: clamp to min and max, pow
// to products, rand to a draw slot, angleTo to an input that the expander fills.
#include "runtime/grammar/expressions.hpp"

#include <algorithm>

#include "shaders/shared/roof_records.h"

namespace espalier::grammar {
namespace {

constexpr uint64_t kMaxWork = 300'000;
constexpr size_t kMaxLets = 64;      // that use each other in a row
constexpr uint32_t kMaxGraph = 256;  // operations that use each other in a row: later stages recurse over them

std::string countText(uint32_t least, uint32_t most) {
    if (least == most) return std::to_string(least) + (least == 1 ? " argument" : " arguments");
    return std::to_string(least) + " to " + std::to_string(most) + " arguments";
}

}  // namespace

Expressions::Expressions(Module& module, Reporter& reporter, Graph& graph)
    : module_(module), reporter_(reporter), graph_(graph) {}

bool Expressions::withinBudget(const Place& place, const std::string& rule) {
    if (++work_ == kMaxWork)
        reporter_.error(place, rule,
                        "the grammar unfolds into too much; are lets or successors nested in each other many times?");
    return work_ < kMaxWork;
}

bool Expressions::takeName(const std::string& name, const Place& place) {
    std::string reserved = reservedFor(name);
    if (!reserved.empty()) {
        reporter_.error(place, name, reserved + "; take another");
        return false;
    }
    if (!names_.insert(name).second) {
        reporter_.error(place, name, "'" + name + "' is declared twice");
        return false;
    }
    return true;
}

float Expressions::constantOf(ExprId expr, const std::string& rule, float otherwise) {
    if (expr == kNoExpr) return otherwise;
    Env env;
    env.rule = rule;
    Node node = lower(expr, env);
    if (graph_.isConstant(node)) return graph_[node].value;
    reporter_.error(module_.exprs[expr].place, rule, "a declaration's numbers must be constants");
    return otherwise;
}

void Expressions::declareParam(const ParamDeclaration& p, uint32_t& slots) {
    if (!takeName(p.name, p.place)) return;
    ParamInfo info;
    info.name = p.name;
    info.unit = p.unit;
    info.label = p.label.empty() ? p.name : p.label;
    info.kind = p.colour ? ParamKind::colour : p.toggle ? ParamKind::toggle : ParamKind::number;
    info.slot = slots;
    slots += p.colour ? 3 : 1;
    if (slots > kMaxParams) {
        reporter_.error(p.place, p.name, "too many parameters: 32 are the most, a colour counting as three");
        return;
    }
    if (p.colour) {
        std::copy(p.rgb, p.rgb + 3, info.standard);
    } else {
        info.standard[0] = constantOf(p.standard, p.name, 0);
        float d = info.standard[0];
        bool ranged = p.minimum != kNoExpr && !p.toggle;
        info.minimum = ranged ? constantOf(p.minimum, p.name, 0) : p.toggle ? 0 : std::min(0.0f, 2 * d);
        info.maximum = ranged ? constantOf(p.maximum, p.name, 1) : p.toggle || d == 0 ? 1 : std::max(0.0f, 2 * d);
        if (!(info.minimum < info.maximum))
            reporter_.error(p.place, p.name, "the range is empty: its first number must be the smaller");
        else if (d < info.minimum || d > info.maximum)
            reporter_.error(p.place, p.name, "the default lies outside the range");
    }
    std::copy(info.standard, info.standard + 3, info.value);
    paramByName_[p.name] = static_cast<uint32_t>(params.size());
    params.push_back(std::move(info));
}

void Expressions::declare() {
    uint32_t slots = 0;
    for (const ParamDeclaration& p : module_.params) {
        declareParam(p, slots);
        if (slots > kMaxParams) break;
    }
    for (const ContextDeclaration& c : module_.contexts) {
        if (!takeName(c.name, c.place)) continue;
        if (contexts.size() == kMaxLayers) {
            reporter_.error(c.place, c.name, "too many context layers: 16 are the most");
            break;
        }
        float fill = constantOf(c.fill, c.name, 1.0f);
        if (fill < 0 || fill > 1) reporter_.error(c.place, c.name, "a layer's default lies between 0 and 1");
        contextByName_[c.name] = static_cast<uint32_t>(contexts.size());
        contexts.push_back({c.name, c.label.empty() ? c.name : c.label, fill});
    }
    for (uint32_t i = 0; i < module_.lets.size(); ++i)
        if (takeName(module_.lets[i].name, module_.lets[i].place)) letByName_[module_.lets[i].name] = i;
}

bool Expressions::known(const std::string& name) const {
    return names_.count(name) != 0;
}

void Expressions::warnUnused() {
    auto warn = [&](const Place& place, const std::string& name, const char* what) {
        bool ours = place.file == 0;  // included texts are libraries
        if (ours && known(name) && used_.count(name) == 0)
            reporter_.warning(place, name, std::string(what) + " '" + name + "' is never used");
    };
    for (const ParamDeclaration& p : module_.params) warn(p.place, p.name, "the parameter");
    for (const ContextDeclaration& c : module_.contexts) warn(c.place, c.name, "the context layer");
    for (const LetDeclaration& l : module_.lets) warn(l.place, l.name, "the value");
}

Node Expressions::fail(const Place& place, const Env& env, const std::string& message) {
    reporter_.error(place, env.rule, message);
    return graph_.zero();
}

Node Expressions::unknown(const std::string& name, const Place& place, const Env& env) {
    std::vector<std::string> candidates = roofs_ ? roofAccessorNames() : accessorNames();
    for (const auto& arg : env.args) candidates.push_back(arg.first);
    candidates.insert(candidates.end(), names_.begin(), names_.end());
    return fail(place, env, "'" + name + "' is not known" + didYouMean(name, candidates));
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
        used_.insert(name);
        if (activeLets_.size() >= kMaxLets) return fail(place, env, "more than 64 lets are nested in each other");
        if (!activeLets_.insert(name).second) return fail(place, env, "'" + name + "' is defined by itself");
        // A let sees the declarations, not the arguments of the rule that uses it.
        std::vector<std::pair<std::string, Node>> args;
        args.swap(env.args);
        Node node = lower(module_.lets[found->second].value, env);
        args.swap(env.args);
        activeLets_.erase(name);
        return node;
    }
    if (name == "pi") return graph_.constant(kPi);
    if (name == "true" || name == "otherwise") return graph_.one();
    if (name == "false") return graph_.zero();
    if (roofs_) {
        if (const AccessorInfo* info = findRoofAccessor(name)) return graph_.leaf(Leaf::slot, info->slot);
        if (const float* word = findRoofWord(name)) return graph_.constant(*word);
        if (findAccessor(name) != nullptr)
            return fail(place, env, "'" + name + "' belongs to growth over a surface; a grammar of roofs has no walk");
        if (findRoofAccessor(name + ".x") != nullptr || (letByName_.count(base) != 0 && !part.empty()))
            return fail(place, env, "'" + name + "' is a vector; here a number is wanted, such as " + base + ".x");
        return unknown(name, place, env);
    }
    if (const AccessorInfo* info = findAccessor(name)) return accessor(*info, place, env);
    if (contextByName_.count(base == "context" ? part : name) != 0) {
        std::string layerName = base == "context" ? part : name;
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
    return fail(module_.exprs[id].place, env, "the expression unfolds into more than 256 operations in a row");
}

Node Expressions::lowerTree(ExprId id, Env& env) {
    const Expr& e = module_.exprs[id];
    if (!withinBudget(e.place, env.rule)) return graph_.zero();
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
        // Dividing by what is fixed while growing is multiplying by its inverse, which the host works out.
        bool fixed = g.isConstant(y) || g[y].uniform;
        Node quotient = fixed ? g.mul(x, g.make(kOpDiv, g.one(), y)) : g.make(kOpDiv, x, y);
        if (e.text == "/") return quotient;
        return g.sub(x, g.mul(y, g.make(kOpFloor, quotient)));
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

Node Expressions::call(const Expr& e, Env& env) {
    std::string name = e.text;
    bool qualified = name.rfind("context.", 0) == 0;
    if (qualified) name = name.substr(8);
    if (contextByName_.count(name) != 0) return layer(name, e, env);
    if (qualified) {
        std::vector<std::string> candidates;
        for (const auto& c : contextByName_) candidates.push_back(c.first);
        return fail(e.place, env, "no context layer '" + name + "' is declared" + didYouMean(name, candidates));
    }
    if (roofs_ && e.kids.empty() && findRoofAccessor(name) != nullptr) return lowerName(name, e.place, env);
    if (name == "~" || name == "rel")
        return fail(e.place, env,
                    std::string(name == "~" ? "'~'" : "'rel'") + " is a size of Split and stands there only");
    const FunctionInfo* info = findFunction(name);
    if (roofs_ && info != nullptr && (info->kind == Function::angleTo || info->kind == Function::every))
        return fail(e.place, env, "'" + name + "' belongs to growth over a surface; a grammar of roofs has no walk");
    if (info == nullptr) {
        std::vector<std::string> candidates = functionNames();
        for (const auto& c : contextByName_) candidates.push_back(c.first);
        return fail(e.place, env,
                    "there is no function or context layer '" + name + "'" + didYouMean(name, candidates));
    }
    if (e.kids.size() < info->minArgs || e.kids.size() > info->maxArgs)
        return fail(e.place, env,
                    name + " takes " + countText(info->minArgs, info->maxArgs) + ", not " +
                        std::to_string(e.kids.size()) + ": " + std::string(info->usage));
    return function(*info, e, env);
}

Node Expressions::layer(const std::string& name, const Expr& e, const Env& env) {
    used_.insert(name);
    auto named = [&](const char* word) {
        return e.kids.size() == 1 && module_.exprs[e.kids[0]].kind == ExprKind::name &&
               module_.exprs[e.kids[0]].text == word;
    };
    const uint32_t index = contextByName_.at(name);
    if (roofs_ && index >= kRoofLayers) return fail(e.place, env, "a grammar of roofs reads at most 8 layers");
    if (roofs_ && named("house")) return graph_.leaf(Leaf::slot, kSlotLayer + kRoofLayers + index);
    if (!named("texCoord"))
        return fail(e.place, env,
                    "a layer is read where the shape stands: write " + name + "(texCoord)" +
                        (roofs_ ? ", or over the whole house: " + name + "(house)" : ""));
    return graph_.leaf(Leaf::slot, kSlotLayer + index);
}

Node Expressions::layerNumber(ExprId id, Env& env) {
    const Expr& e = module_.exprs[id];
    auto found = e.kind == ExprKind::name ? contextByName_.find(e.text) : contextByName_.end();
    if (found == contextByName_.end() || found->second >= kRoofLayers)
        return fail(e.place, env, "the name of one of the first 8 context layers must stand here");
    used_.insert(e.text);
    return graph_.constant(float(found->second + 1));
}

Node Expressions::siteNode(Graph& graph, const Env& env, uint32_t ordinal) {
    uint32_t site = static_cast<uint32_t>(mix64((uint64_t(env.sitePrefix) << 32) | ordinal)) & 0x7FFFFFFFu;
    return graph.leaf(Leaf::draw, site | (env.where == Where::inRepeat ? kSiteOfInstance : 0u));
}
Node Expressions::randomNumber(Env& env) {
    return siteNode(graph_, env, env.nextSite++);
}

Node Expressions::function(const FunctionInfo& info, const Expr& e, Env& env) {
    Graph& g = graph_;
    if (info.kind == Function::angleTo) return angleTo(e, env);
    if (info.kind == Function::facing) {
        Node d[3];
        if (!direction(e, env, d)) return g.zero();
        Node sum = g.zero();
        for (uint32_t i = 0; i < 3; ++i) sum = g.add(g.mul(g.leaf(Leaf::slot, kSlotNormal + i), d[i]), sum);
        return sum;
    }
    if (info.kind == Function::random && e.kids.size() == 1)
        return fail(e.place, env, "rand takes no argument or two: rand() or rand(from, to)");
    Node draw = info.kind == Function::random ? randomNumber(env) : 0;
    Node a[3] = {};
    for (size_t i = 0; i < e.kids.size() && !(info.kind == Function::power && i == 1); ++i)
        a[i] = lower(e.kids[i], env);
    switch (info.kind) {
        case Function::random:
            return e.kids.empty() ? draw : g.mix(a[0], a[1], draw);
        case Function::minimum:
            return g.make(kOpMin, a[0], a[1]);
        case Function::maximum:
            return g.make(kOpMax, a[0], a[1]);
        case Function::clamp:
            return g.make(kOpMin, g.make(kOpMax, a[0], a[1]), a[2]);
        case Function::mix:
            return g.mix(a[0], a[1], a[2]);
        case Function::absolute:
            return g.make(kOpAbs, a[0]);
        case Function::floor:
            return g.make(kOpFloor, a[0]);
        case Function::ceil:
            return g.sub(g.zero(), g.make(kOpFloor, g.sub(g.zero(), a[0])));
        case Function::fract:
            return g.sub(a[0], g.make(kOpFloor, a[0]));
        case Function::sign:
            return g.sub(g.make(kOpLess, g.zero(), a[0]), g.make(kOpLess, a[0], g.zero()));
        case Function::sqrt:
            return g.make(kOpSqrt, a[0]);
        case Function::sin:
            return g.make(kOpSin, a[0]);
        case Function::cos:
            return g.make(kOpCos, a[0]);
        case Function::power:
            return power(a[0], e, env);
        case Function::smoothstep: {
            Node t = g.make(kOpDiv, g.sub(a[2], a[0]), g.sub(a[1], a[0]));
            t = g.make(kOpMin, g.make(kOpMax, t, g.zero()), g.one());
            return g.mul(g.mul(t, t), g.sub(g.constant(3), g.mul(g.constant(2), t)));
        }
        case Function::every: {
            if (env.where == Where::anywhere)
                return fail(e.place, env, "every counts along a span; use it in extruded successors");
            Node inverse = g.make(kOpDiv, g.one(), a[0]);
            Node arc = g.leaf(Leaf::slot, kSlotArc);
            Node before = g.sub(arc, g.leaf(Leaf::slot, kSlotSpanLength));
            return g.sub(g.make(kOpFloor, g.mul(arc, inverse)), g.make(kOpFloor, g.mul(before, inverse)));
        }
        default:
            return g.zero();
    }
}

Node Expressions::power(Node x, const Expr& e, Env& env) {
    Node exponent = lower(e.kids[1], env);
    float n = graph_[exponent].value;
    bool whole = graph_.isConstant(exponent) && n >= 0 && n <= 8 && n == floorExact(n);
    if (!whole) return fail(e.place, env, "pow's exponent must be a constant whole number from 0 to 8");
    Node result = graph_.one();
    for (int i = 0; i < static_cast<int>(n); ++i) result = graph_.mul(result, x);
    return result;
}

// A named direction or three numbers, made a unit vector.
bool Expressions::direction(const Expr& e, Env& env, Node (&xyz)[3]) {
    Graph& g = graph_;
    if (e.kids.size() == 1) {
        const Expr& name = module_.exprs[e.kids[0]];
        const DirectionInfo* info = name.kind == ExprKind::name ? findDirection(name.text) : nullptr;
        if (info == nullptr) {
            fail(name.place, env, "expected a direction: up, down, north, east, south, west, or x, y, z");
            return false;
        }
        xyz[0] = g.constant(info->x);
        xyz[1] = g.constant(info->y);
        xyz[2] = g.constant(info->z);
        return true;
    }
    if (e.kids.size() != 3) {
        fail(e.place, env, "a direction is a name or three numbers: " + e.text + "(x, y, z)");
        return false;
    }
    Node square = g.zero();
    for (int i = 0; i < 3; ++i) {
        xyz[i] = lower(e.kids[i], env);
        square = g.add(g.mul(xyz[i], xyz[i]), square);
    }
    Node inverse = g.make(kOpDiv, g.one(), g.make(kOpSqrt, square));
    for (Node& n : xyz) n = g.mul(n, inverse);
    return true;
}

Node Expressions::angleTo(const Expr& e, Env& env) {
    Node d[3];
    if (!direction(e, env, d)) return graph_.zero();
    for (Node n : d)
        if (!graph_.isConstant(n) && !graph_[n].uniform)
            return fail(e.place, env, "angleTo's direction may use numbers and parameters only");
    for (uint32_t i = 0; i < directions.size() / 3; ++i)
        if (std::equal(d, d + 3, &directions[3 * i])) return graph_.leaf(Leaf::slot, kSlotAngle + i);
    if (directions.size() / 3 == kMaxDirections)
        return fail(e.place, env, "angleTo is asked for more than 4 directions in this grammar");
    directions.insert(directions.end(), d, d + 3);
    return graph_.leaf(Leaf::slot, kSlotAngle + static_cast<uint32_t>(directions.size() / 3) - 1);
}

bool Expressions::lowerColour(const std::vector<ExprId>& args, const Place& place, Env& env, Node (&rgb)[3]) {
    if (args.size() == 1) {
        const Expr& e = module_.exprs[args[0]];
        auto found = e.kind == ExprKind::name ? paramByName_.find(e.text) : paramByName_.end();
        if (found == paramByName_.end() || params[found->second].kind != ParamKind::colour) {
            fail(place, env, "Colour takes a colour parameter or three numbers");
            return false;
        }
        used_.insert(e.text);
        for (uint32_t i = 0; i < 3; ++i) rgb[i] = graph_.leaf(Leaf::param, params[found->second].slot + i);
        return true;
    }
    if (args.size() != 3) {
        fail(place, env, "Colour takes a colour parameter or three numbers");
        return false;
    }
    for (int i = 0; i < 3; ++i) {
        rgb[i] = lower(args[i], env);
        if (graph_.isConstant(rgb[i]) || graph_[rgb[i]].uniform) continue;
        fail(place, env, "Colour may use numbers and parameters only");
        return false;
    }
    return true;
}

}  // namespace espalier::grammar
