// Calls in expressions -> graph nodes: functions, painted layers, angleTo, colours.
#include "runtime/grammar/expressions.hpp"
#include "shaders/shared/roof_records.h"

namespace espalier::grammar {
namespace {

std::string countText(uint32_t least, uint32_t most) {
    if (least == most) return std::to_string(least) + (least == 1 ? " argument" : " arguments");
    return std::to_string(least) + " to " + std::to_string(most) + " arguments";
}

}  // namespace

Node Expressions::call(const Expr& e, Env& env) {
    std::string name = e.text;
    if (const std::optional<Node> relation = fieldRelation(e, env)) return *relation;
    bool qualified = name.rfind("context.", 0) == 0;
    if (qualified) name = name.substr(8);
    if (contextByName_.count(name) != 0) return layer(name, e, env);
    if (colourContexts_.count(name) != 0)
        return fail(e.place, env,
                    "'" + name + "' is a layer of colours: write Colour(" + name + "(texCoord)), or " + name +
                        ".r(texCoord), .g and .b");
    if (mistaken(name)) return graph_.mistake();
    if (qualified) {
        std::vector<std::string> candidates;
        for (const auto& c : contextByName_) candidates.push_back(c.first);
        return fail(e.place, env, "no context layer '" + name + "' is declared" + didYouMean(name, candidates));
    }
    if (roofs() && e.kids.empty() && findRoofAccessor(name) != nullptr) return lowerName(name, e.place, env);
    if (name == "~" || name == "rel")
        return fail(e.place, env,
                    std::string(name == "~" ? "'~'" : "'rel'") + " is a size of Split and stands there only");
    const FunctionInfo* info = findFunction(name);
    if (roofs() && info != nullptr && (info->kind == Function::angleTo || info->kind == Function::every))
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
    used_.insert(name.substr(0, name.find('.')));
    auto named = [&](const char* word) {
        return e.kids.size() == 1 && module_.exprs[e.kids[0]].kind == ExprKind::name &&
               module_.exprs[e.kids[0]].text == word;
    };
    const uint32_t index = contextByName_.at(name);
    if (roofs() && index >= kRoofLayers) return fail(e.place, env, "a grammar of roofs reads at most 8 layers");
    if (roofs() && named("house")) return graph_.leaf(Leaf::slot, kSlotLayer + kRoofLayers + index);
    if (!named("texCoord"))
        return fail(e.place, env,
                    "a layer is read where the shape stands: write " + name + "(texCoord)" +
                        (roofs() ? ", or over the whole house: " + name + "(house)" : ""));
    return graph_.leaf(Leaf::slot, kSlotLayer + index);
}

Node Expressions::layerNumber(ExprId id, Env& env) {
    const Expr& e = module_.exprs[id];
    auto found = e.kind == ExprKind::name ? contextByName_.find(e.text) : contextByName_.end();
    if (found == contextByName_.end() && mistaken(e.text)) return graph_.mistake();
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
        if (!direction(e, env, d)) return g.mistake();
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
            Node arc = g.leaf(Leaf::slot, kSlotArc);
            Node before = g.sub(arc, g.leaf(Leaf::slot, kSlotSpanLength));
            if (g.isConstant(a[0], 0.0f)) return g.zero();
            return g.sub(g.make(kOpFloor, g.quotient(arc, a[0])), g.make(kOpFloor, g.quotient(before, a[0])));
        }
        default:
            return g.zero();
    }
}

Node Expressions::power(Node x, const Expr& e, Env& env) {
    Node exponent = lower(e.kids[1], env);
    if (graph_.isMistaken(exponent)) return exponent;
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
    if (!direction(e, env, d)) return graph_.mistake();
    for (Node n : d)
        if (!graph_.isConstant(n) && !graph_[n].uniform)
            return fail(e.place, env, "angleTo's direction may use numbers and parameters only");
    for (uint32_t i = 0; i < directions.size() / 3; ++i)
        if (std::equal(d, d + 3, &directions[3 * i])) return graph_.leaf(Leaf::slot, kSlotAngle + i);
    if (directions.size() / 3 == kMaxDirections)
        return fail(e.place, env, "angleTo is asked for more than 4 directions in this grammar");
    directions.insert(directions.end(), d, d + 3);
    const Node angle = graph_.leaf(Leaf::slot, kSlotAngle + static_cast<uint32_t>(directions.size() / 3) - 1);
    for (Node n : d) graph_.dependsOn(angle, graph_[n].params);
    return angle;
}

bool Expressions::lowerColour(const std::vector<ExprId>& args, const Place& place, Env& env, Node (&rgb)[3]) {
    if (args.size() == 1) {
        const Expr& e = module_.exprs[args[0]];
        const std::string name = e.text.rfind("context.", 0) == 0 ? e.text.substr(8) : e.text;
        if (e.kind == ExprKind::call && colourContexts_.count(name) != 0) {
            const bool read = e.kids.size() == 1 && module_.exprs[e.kids[0]].kind == ExprKind::name;
            const std::string at = read ? module_.exprs[e.kids[0]].text : "";
            if (at != "texCoord" && !(roofs() && at == "house")) {
                fail(place, env, "a layer of colours is read where the shape stands: Colour(" + name + "(texCoord))");
                return false;
            }
            for (uint32_t i = 0; i < 3; ++i) rgb[i] = layer(name + kChannels[i], e, env);
            return !graph_.isMistaken(rgb[0]);
        }
        auto found = e.kind == ExprKind::name ? paramByName_.find(e.text) : paramByName_.end();
        if (found == paramByName_.end() && mistaken(e.text)) return false;
        if (found == paramByName_.end() || params[found->second].kind != ParamKind::colour) {
            fail(place, env, "Colour takes a colour parameter, a layer of colours or three numbers");
            return false;
        }
        used_.insert(e.text);
        for (uint32_t i = 0; i < 3; ++i) rgb[i] = graph_.leaf(Leaf::param, params[found->second].slot + i);
        return true;
    }
    if (args.size() != 3) {
        fail(place, env, "Colour takes a colour parameter, a layer of colours or three numbers");
        return false;
    }
    for (int i = 0; i < 3; ++i) rgb[i] = lower(args[i], env);
    return true;
}

}  // namespace espalier::grammar
