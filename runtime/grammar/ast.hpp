#pragma once

#include <algorithm>
#include <cstdint>
#include <set>
#include <string>
#include <vector>

#include "runtime/core/result.hpp"

// What the parser leaves: declarations and rules, in the text's order. It knows no rule kinds, commands or
// functions by name; vocabulary.hpp lists those, and check and lowering consult it.
namespace espalier::grammar {

struct Place {
    uint32_t file = 0;  // index into Module::files
    int line = 0, column = 0;
};

using ExprId = uint32_t;
inline constexpr ExprId kNoExpr = 0xFFFFFFFFu;

enum class ExprKind : uint8_t { number, string, name, call, unary, binary, choice };

// `text`: the name ("n", "context.mask", "normal.y"), the called function, the operator, or the string.
struct Expr {
    ExprKind kind = ExprKind::number;
    std::string text;
    float value = 0;
    std::vector<ExprId> kids;
    Place place;
    int depth = 1;  // of the tree below, limited by the parser so that walks over it may recurse
};

struct Element;
using Sequence = std::vector<Element>;

// Name(args) {item, item}, or "[" or "]".
struct Element {
    std::string name;
    std::vector<ExprId> args;
    bool hasItems = false;
    std::vector<Sequence> items;
    Place place;
};

struct Rule {
    std::string predecessor;
    std::vector<std::string> args;
    ExprId condition = kNoExpr;
    Sequence successor;
    ExprId probability = kNoExpr;
    ExprId priority = kNoExpr;
    Place place;
};

struct ParamDeclaration {
    std::string name, unit, label;
    ExprId standard = kNoExpr, minimum = kNoExpr, maximum = kNoExpr;
    bool toggle = false, colour = false;
    float rgb[3] = {};
    Place place;
};

struct ContextDeclaration {
    std::string name, label;
    ExprId fill = kNoExpr;
    bool colour = false;
    float rgb[3] = {};
    Place place;
};

struct LetDeclaration {
    std::string name;
    ExprId value = kNoExpr;
    Place place;
};

// field name : kind "label"
struct FieldDeclaration {
    std::string name, kind, label;
    ExprId symmetry = kNoExpr;  // of symmetry(N)
    bool jumps = false;
    Place place;
};

// `width` or `avoid`: a length of all that the grammar grows.
struct LengthDeclaration {
    ExprId value = kNoExpr;
    Place place;
};

struct Module {
    std::vector<std::string> files;  // 0: the main text
    std::vector<Expr> exprs;
    std::vector<Rule> rules;
    std::vector<ParamDeclaration> params;
    std::vector<ContextDeclaration> contexts;
    std::vector<LetDeclaration> lets;
    std::vector<FieldDeclaration> fields;
    bool degrees = false;                           // angles are in degrees, of grammars of patterns
    std::vector<LengthDeclaration> widths, avoids;  // more than one of either is a mistake, to be reported
    std::set<std::string> mistaken;  // names whose statement couldn't be read: who uses them isn't to blame
};

// Collects diagnostics, up to a number of mistakes and one of warnings that a reader can still use.
class Reporter {
  public:
    explicit Reporter(Module& module) : module_(module) {}
    void error(const Place& place, const std::string& rule, std::string message) { add(place, rule, message, false); }
    void warning(const Place& place, const std::string& rule, std::string message) { add(place, rule, message, true); }
    bool failed() const { return errors_ > 0; }
    bool full() const { return errors_ >= kMost; }
    bool warnedEnough() const { return warnings_ >= kMost; }
    std::vector<Diagnostic>& all() { return all_; }

  private:
    void add(const Place& place, const std::string& rule, std::string& message, bool warning) {
        if ((warning ? warnings_ : errors_) >= kMost) return;
        std::string file = place.file < module_.files.size() ? module_.files[place.file] : std::string();
        // An expression that is used for several things is compiled for each.
        const bool told = std::ranges::any_of(all_, [&](const Diagnostic& d) {
            return d.line == place.line && d.column == place.column && d.message == message && d.file == file;
        });
        if (told) return;
        all_.push_back({file, place.line, place.column, rule, std::move(message), warning});
        (warning ? warnings_ : errors_) += 1;
    }
    static constexpr size_t kMost = 40;
    Module& module_;
    std::vector<Diagnostic> all_;
    size_t errors_ = 0, warnings_ = 0;
};

}  // namespace espalier::grammar
