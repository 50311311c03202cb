#pragma once

#include <doctest/doctest.h>

#include <filesystem>
#include <fstream>
#include <random>
#include <sstream>
#include <string>

#include "runtime/grammar/grammar.hpp"
#include "shaders/tests/interpreter_case.h"

// What the grammar's tests share: compile or fail the test, run a stage of a rule as the expander does.
namespace grammar_test {

using namespace espalier;

inline RuleMap compiled(const std::string& text) {
    Result<RuleMap> map = compileGrammar(text);
    INFO(text);
    if (!map) FAIL(map.failure().text());
    return std::move(map.value());
}
inline std::string failureText(const std::string& text) {
    Result<RuleMap> map = compileGrammar(text);
    return map ? std::string("compiled") : map.failure().text();
}

inline RuleRecord ruleOf(const RuleMap& map, const char* symbol, uint32_t rule = 0) {
    RuleMapRef ref = map.ref();
    SymbolRecord s = ref.symbols.v[map.findSymbol(symbol).value()];
    REQUIRE(rule < s.ruleCount);
    return ref.rules.v[s.firstRule + rule];
}
inline SuccessorRecord successorOf(const RuleMap& map, const RuleRecord& rule, uint32_t i) {
    REQUIRE(i < rule.successorCount);
    return map.ref().successors.v[rule.firstSuccessor + i];
}

// A machine ready for a shape with these arguments.
inline Machine machineFor(const std::vector<float>& args) {
    Machine machine;
    resetMachine(MACHINE_ONLY);
    for (uint32_t i = 0; i < args.size(); ++i) SLOT(kSlotArg + i) = args[i];
    return machine;
}
// The rule that the symbol's shape with this key takes, or -1.
inline int chosenRule(const RuleMap& map, const char* symbol, Machine& machine, uint64_t key) {
    RuleMapRef ref = map.ref();
    SymbolRecord s = ref.symbols.v[map.findSymbol(symbol).value()];
    drawSites(MACHINE ref.sites, s.firstSite, s.siteCount, key, key);
    runCode(MACHINE ref.code, s.select);
    return selectedRule(MACHINE s);
}
inline void startRule(const RuleMap& map, const RuleRecord& rule, Machine& machine, uint64_t key) {
    RuleMapRef ref = map.ref();
    drawSites(MACHINE ref.sites, rule.firstSite, rule.siteCount, key, key);
    runCode(MACHINE ref.code, rule.start);
}
inline float angleOf(const RuleMap& map, const char* symbol, Machine& machine, uint64_t key = 1) {
    RuleRecord rule = ruleOf(map, symbol);
    startRule(map, rule, machine, key);
    return valueOf(MACHINE rule.angle);
}

inline std::string contentsOf(const std::filesystem::path& path) {
    std::ifstream in(path, std::ios::binary);
    REQUIRE(in.good());
    std::stringstream all;
    all << in.rdbuf();
    return all.str();
}

}  // namespace grammar_test
