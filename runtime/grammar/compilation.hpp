#pragma once

#include <functional>
#include <map>
#include <string>
#include <vector>

#include "runtime/grammar/codegen.hpp"
#include "runtime/grammar/expressions.hpp"

// One compilation: what its stages share. Stages in order: parseModule, Expressions::declare, analyseSymbols,
// lowerGrowth (which calls lowerExtrude), or for roofs lowerRoofs, assemble (rule_map_io.hpp).
namespace espalier::grammar {

// All rules of one predecessor.
struct Symbol {
    std::string name;
    std::vector<uint32_t> rules;  // indices into Module::rules
    uint32_t argCount = 0;
    bool grows = false;    // reaches Marching
    bool vanishes = true;  // derives NULL only
    bool called = false;
    uint32_t record = kNoIndex;  // growing ones: index into the map's symbols
};

inline constexpr uint32_t kNoSymbol = 0xFFFFFFFFu;

struct Compilation {
    Compilation(const CompileOptions& o)
        : options(o), reporter(module), expressions(module, reporter, graph), code(graph) {}

    const CompileOptions& options;
    Module module;
    Reporter reporter;
    Graph graph;
    Expressions expressions;
    CodeGenerator code;

    std::vector<Symbol> symbols;
    std::map<std::string, uint32_t> symbolByName;
    uint32_t startSymbol = 0;  // record index
    FixedLength width, avoid;

    std::vector<SymbolRecord> symbolRecords;
    std::vector<RuleRecord> rules;
    std::vector<SuccessorRecord> successors;
    std::vector<ExtrudeRecord> extrudes;
    std::vector<TerminalRecord> terminals;
    std::vector<uint32_t> sites;
    std::vector<Value> roofValues;         // the numbers of their rules
    std::vector<std::string> nestedNames;  // of symbols that stand behind all named ones
    std::vector<PatternPart> parts;        // of grammars of patterns
    std::vector<PatternOp> ops;
    GrammarKind kind = GrammarKind::plants;

    uint32_t findSymbol(const std::string& name) const {
        auto found = symbolByName.find(name);
        return found == symbolByName.end() ? kNoSymbol : found->second;
    }
    // Reports a successor's name that is no symbol, with a hint.
    void reportUnknown(const Element& element, const std::string& rule);
    // True if a call's arguments are as many as the symbol takes; else reports.
    bool checkArgs(const Element& element, const Symbol& symbol, const std::string& rule);
    // Generates code; reports what goes wrong at `place`.
    bool generate(std::span<const Node> roots, StageReads& sites, StageReads& reads, CodeRange& range,
                  std::span<Value> values, const Place& place, const std::string& rule);
    uint32_t storeSites(const StageReads& reads);
    // Environment of the number `ordinal` among the rules of its predecessor; args: its arguments' nodes.
    Env environment(const Rule& rule, uint32_t ordinal, std::span<const Node> args) const;
    // Which of a symbol's rules applies: the first whose condition holds; among rules of equal condition by
    // probability. envs: one a rule, in order. Constant -1 where none is left.
    Node chooseRule(const Symbol& symbol, std::vector<Env>& envs);
    // Fills the symbol's record with the code of that choice and room for its rules behind all that are there. args:
    // its arguments' nodes. Returns the environments of its rules.
    std::vector<Env> lowerChoice(const Symbol& symbol, std::span<const Node> args);
};

// What its rules make.
GrammarKind kindOf(const Module& module);

// Fills Compilation::symbols with the rules of each predecessor; reports what contradicts itself.
void collectSymbols(Compilation& c);

// The same, and who grows, who calls whom; reports cycles that never march, duplicates, nesting.
void analyseSymbols(Compilation& c);
void warnUnreached(Compilation& c);  // of growth, when all else is known to be right

// Rules, successors and continuations of the growing symbols.
void lowerGrowth(Compilation& c);

// All rules of a grammar of roofs (Buron 2013).
void lowerRoofs(Compilation& c);

// All rules of a grammar of patterns (Li 2011).
void lowerPatterns(Compilation& c);

// The program of an extruded successor of `rule`; args: the nodes of the rule's arguments. Returns its index + 1, or
// 0 if nothing is drawn or a mistake was reported.
uint32_t lowerExtrude(Compilation& c, const Rule& rule, uint32_t ordinal, const Sequence& extruded,
                      std::span<const Node> args);

// Calls fn for every element of a sequence and of the sequences in it.
void forEachElement(const Sequence& sequence, const std::function<void(const Element&)>& fn);

}  // namespace espalier::grammar
