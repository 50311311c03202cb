#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "runtime/grammar/ast.hpp"
#include "runtime/grammar/grammar.hpp"
#include "runtime/grammar/graph.hpp"
#include "runtime/grammar/vocabulary.hpp"

namespace espalier::grammar {

// What an expression may refer to. Random numbers get stable sites: they depend on the rule's name, on which of the
// rules of that name it is, and on their ordinal in it, not on the rest of the grammar.
struct Env {
    std::string rule;  // for diagnostics
    std::vector<std::pair<std::string, Node>> args;
    Where where = Where::anywhere;
    uint32_t sitePrefix = 0;
    uint32_t nextSite = 0;
};

// While a let is lowered: it sees the declarations, not the arguments of the rule that uses it, and its mistakes are
// its own.
class LetScope {
  public:
    LetScope(Env& env, std::string name) : env_(env), rule_(std::move(name)) { swap(); }
    ~LetScope() { swap(); }
    LetScope(const LetScope&) = delete;

  private:
    void swap() {
        env_.rule.swap(rule_);
        env_.args.swap(args_);
    }
    Env& env_;
    std::string rule_;
    std::vector<std::pair<std::string, Node>> args_;
};

// Turns expressions into graph nodes; knows the declarations.
class Expressions {
  public:
    Expressions(Module& module, Reporter& reporter, Graph& graph);

    // Reads params, contexts and lets of the module; reports what is wrong with them.
    void declare();

    // Mistakes are reported; the node is Graph::mistake() then.
    Node lower(ExprId expr, Env& env);
    Node lowerName(const std::string& name, const Place& place, Env& env);
    // x + y, of commands that add up; reported where too many have.
    Node sum(Node x, Node y, const Place& place, const Env& env);
    // Grammars of roofs have accessors of their own, and vectors; those of patterns ask fields. To be said before
    // declare().
    void ofKind(GrammarKind kind) { kind_ = kind; }
    // A vector of 2 or 3 parts (`size`; of two the last part is 0): an accessor, vec2, vec3, cross, unit, sums,
    // products with numbers, a let of such. False: reported.
    bool lowerVector(ExprId expr, Env& env, Node (&xyz)[3], int& size);
    // Three nodes of a colour: a colour parameter, a layer of colours or three numbers. False: reported.
    bool lowerColour(const std::vector<ExprId>& args, const Place& place, Env& env, Node (&rgb)[3]);
    // A layer's name, as a constant: its number in the grammar + 1. Of grammars of roofs.
    Node layerNumber(ExprId id, Env& env);
    bool isVector(ExprId expr, int depth = 0) const;
    Node randomNumber(Env& env);
    static Node siteNode(Graph& graph, const Env& env, uint32_t ordinal);

    bool known(const std::string& name) const;
    // Takes note of so much work. False once the whole compilation has done more than a grammar could need; reports it
    // the first time.
    bool withinBudget(const Place& place, const std::string& rule, uint64_t work = 1);
    void warnUnused();

    std::vector<ParamInfo> params;
    std::vector<ContextInfo> contexts;
    std::vector<Node> directions;  // three nodes each
    std::vector<FieldInfo> fields;
    std::vector<uint32_t> queries;  // as rule_map.h has them, in the order of their slots

  private:
    // Operations that use each other in a row: later stages recurse over them.
    static constexpr uint32_t kMaxGraph = 256;

    Node lowerTree(ExprId expr, Env& env);
    bool vectorTree(const Expr& e, Env& env, Node (&xyz)[3], int& size);
    bool vectorCall(const Expr& e, Env& env, Node (&xyz)[3], int& size);
    float constantOf(ExprId expr, const std::string& rule, float otherwise);
    void declareParam(const ParamDeclaration& p, uint32_t& slots);
    bool declareContext(const ContextDeclaration& c);
    void declareField(const FieldDeclaration& f);
    std::optional<uint32_t> fieldCalled(const std::string& name);
    std::optional<Node> fieldQuery(const std::string& base, const std::string& part, const Place& place,
                                   const Env& env);
    std::optional<Node> fieldRelation(const Expr& e, const Env& env);
    bool enterLet(const std::string& name, const Place& place, const Env& env);
    Node failTooDeep(const Place& place, const Env& env);
    bool takeName(const std::string& name, const Place& place);
    Node fail(const Place& place, const Env& env, const std::string& message);
    bool mistaken(const std::string& name) const;  // its statement couldn't be read
    Node unknown(const std::string& name, const Place& place, const Env& env);
    Node accessor(const AccessorInfo& info, const Place& place, const Env& env);
    Node binary(const Expr& e, Env& env);
    Node call(const Expr& e, Env& env);
    Node function(const FunctionInfo& info, const Expr& e, Env& env);
    Node power(Node x, const Expr& e, Env& env);
    Node layer(const std::string& name, const Expr& e, const Env& env);
    bool direction(const Expr& e, Env& env, Node (&xyz)[3]);
    Node angleTo(const Expr& e, Env& env);

    Module& module_;
    Reporter& reporter_;
    Graph& graph_;
    std::map<std::string, uint32_t> paramByName_, contextByName_, letByName_;
    std::set<std::string> names_, used_, activeLets_;
    std::set<std::string> colourContexts_;  // each is three contexts, its name with kChannels behind it
    std::map<std::pair<std::string, std::string>, std::string> hints_;  // of a rule and a name that it doesn't know
    uint64_t work_ = 0;
    bool roofs() const { return kind_ == GrammarKind::roofs; }
    GrammarKind kind_ = GrammarKind::plants;
    uint32_t nesting_ = 0;  // calls of lower and lowerVector under way
};

}  // namespace espalier::grammar
