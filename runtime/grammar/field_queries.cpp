// What grammars of patterns ask of fields -> graph nodes (Li 2011 §4.3). A kernel answers a few basic questions, which
// have slots: the values, the angle of the first direction, and how these change along the scope's axes. All else is
// computed from that.
#include <algorithm>
#include <numeric>

#include "runtime/grammar/expressions.hpp"

namespace espalier::grammar {
namespace {

// What is asked of one field; takes note of it. Once something has failed, the nodes are mistakes.
class Asking {
  public:
    Asking(Graph& graph, std::vector<uint32_t>& queries, uint32_t field, const FieldInfo& info)
        : g_(graph), queries_(queries), field_(field), vector_(info.symmetry == 1 && !info.curvature) {}

    bool failed() const { return failed_; }

    Node ask(uint32_t quantity) {
        const uint32_t query = field_ | quantity << 8;
        auto known = std::ranges::find(queries_, query);
        failed_ = failed_ || (known == queries_.end() && queries_.size() == kMaxQueries);
        if (failed_) return g_.mistake();
        if (known == queries_.end()) known = queries_.insert(queries_.end(), query);
        return g_.leaf(Leaf::slot, kSlotQuery + uint32_t(known - queries_.begin()));
    }

    Node gradient(uint32_t which, uint32_t axis) { return ask(kQueryGrowth1X + 2 * which + axis); }
    Node turn(uint32_t axis) { return ask(kQueryTurnX + axis); }
    // Of the unit vector along a direction, 0: along the scope's x axis, 1: to its left.
    Node unit(uint32_t which, uint32_t row) { return g_.make(row == 0 ? kOpCos : kOpSin, ask(kQueryAngle1 + which)); }
    // Eigenvectors have unit length.
    Node vector(uint32_t which, uint32_t row) {
        const Node along = unit(which, row);
        return vector_ ? g_.mul(ask(kQueryValue1), along) : along;
    }
    // How the vector's part `row` changes along the axis `column`: it turns, and grows.
    Node jacobian(uint32_t which, uint32_t row, uint32_t column) {
        const Node turned = g_.mul(vector(which, 1 - row), turn(column));
        const Node turns = row == 0 ? g_.sub(g_.zero(), turned) : turned;
        return vector_ ? g_.add(g_.mul(gradient(0, column), unit(which, row)), turns) : turns;
    }

  private:
    Graph& g_;
    std::vector<uint32_t>& queries_;
    uint32_t field_;
    bool vector_;
    bool failed_ = false;
};

Node answer(Graph& g, Asking& field, const QueryInfo& info) {
    switch (info.asked) {
        case Asked::value:
            return field.ask(kQueryValue1 + info.which);
        case Asked::angle:
            return field.ask(kQueryAngle1 + info.which);
        case Asked::sure:
            return field.ask(kQuerySure);
        case Asked::vector:
            return field.vector(info.which, info.row);
        case Asked::gradient:
            return field.gradient(info.which, info.row);
        case Asked::turn:
            return field.turn(info.row);
        case Asked::jacobian:
            return field.jacobian(info.which, info.row, info.column);
        case Asked::divergence:
            return g.add(field.jacobian(info.which, 0, 0), field.jacobian(info.which, 1, 1));
        case Asked::curl:
            return g.sub(field.jacobian(info.which, 1, 0), field.jacobian(info.which, 0, 1));
    }
    return g.zero();
}

const std::string kTooMany =
    "fields are asked for more than " + std::to_string(kMaxQueries) + " different things in this grammar";

}  // namespace

// A field by its name or, as in Li 2011, by its number F1.
std::optional<uint32_t> Expressions::fieldCalled(const std::string& name) {
    const bool numbered = name.size() == 2 && name[0] == 'F' && name[1] >= '1' && size_t(name[1] - '1') < fields.size();
    auto field = std::ranges::find(fields, name, &FieldInfo::name);
    if (field == fields.end() && numbered) field = fields.begin() + (name[1] - '1');
    if (field == fields.end()) return std::nullopt;
    used_.insert(field->name);
    return uint32_t(field - fields.begin());
}

// F.value1. Nothing: there is no such field.
std::optional<Node> Expressions::fieldQuery(const std::string& base, const std::string& part, const Place& place,
                                            const Env& env) {
    const std::optional<uint32_t> field = fieldCalled(base);
    if (!field) return std::nullopt;
    const QueryInfo* info = findQuery(part);
    if (info == nullptr && findRelation(part) != nullptr)
        return fail(place, env, "two fields are wanted: " + std::string(findRelation(part)->usage));
    if (info == nullptr) {
        const std::vector<std::string> known = queryNames();
        return fail(place, env,
                    "a field is asked for " + base + ".value1, .Xangle1, .sure, .vector1.x, .gradient1.x, .turn.x, " +
                        ".jacobian1.xx, .divergence1 or .curl1" + didYouMean(part, known));
    }
    Asking asking(graph_, queries, *field, fields[*field]);
    const Node value = answer(graph_, asking, *info);
    if (asking.failed()) return fail(place, env, kTooMany);
    const bool angle = info->asked == Asked::angle || info->asked == Asked::turn;
    return angle && module_.degrees ? graph_.mul(value, graph_.constant(180 / kPi)) : value;
}

// F.angleTo(G). Nothing: there is no field F.
std::optional<Node> Expressions::fieldRelation(const Expr& e, const Env& env) {
    const size_t dot = e.text.find('.');
    const std::optional<uint32_t> field = dot == std::string::npos ? std::nullopt : fieldCalled(e.text.substr(0, dot));
    if (!field) return std::nullopt;
    const RelationInfo* info = findRelation(e.text.substr(dot + 1));
    if (info == nullptr)
        return fail(e.place, env,
                    "two fields have .angleTo, .gradient1Along, .gradient2Along or .turnAlong, not '" +
                        e.text.substr(dot + 1) + "'");
    const Expr* named = e.kids.size() == 1 ? &module_.exprs[e.kids[0]] : nullptr;
    const std::optional<uint32_t> other =
        named != nullptr && named->kind == ExprKind::name ? fieldCalled(named->text) : std::nullopt;
    if (!other) return fail(e.place, env, "a field's name is wanted in the brackets: " + std::string(info->usage));

    Graph& g = graph_;
    Asking one(g, queries, *field, fields[*field]), two(g, queries, *other, fields[*other]);
    Node value = g.zero();
    if (info->relation == Relation::angle) {
        // The least of all angles from one's directions to the other's.
        const float n = float(std::lcm(fields[*field].symmetry, fields[*other].symmetry));
        const Node between = g.sub(two.ask(kQueryAngle1), one.ask(kQueryAngle1));
        const Node turns = g.mul(between, g.constant(n / (2 * kPi)));
        const Node whole = g.make(kOpFloor, g.add(turns, g.constant(.5f)));
        value = g.mul(g.sub(turns, whole), g.constant(2 * kPi / n));
    } else {
        const auto slope = [&](uint32_t axis) {
            if (info->relation == Relation::turn) return one.turn(axis);
            return one.gradient(info->relation == Relation::gradient2 ? 1 : 0, axis);
        };
        const Node along = g.mul(slope(0), two.unit(0, 0));
        value = g.add(along, g.mul(slope(1), two.unit(0, 1)));
    }
    if (one.failed() || two.failed()) return fail(e.place, env, kTooMany);
    const bool angle = info->relation == Relation::angle || info->relation == Relation::turn;
    return angle && module_.degrees ? g.mul(value, g.constant(180 / kPi)) : value;
}

}  // namespace espalier::grammar
