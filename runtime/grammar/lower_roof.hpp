#pragma once

// The parts of lowering grammars of roofs that need no other rule's shapes (lower_roof.cpp has the rest).

#include <vector>

#include "runtime/grammar/compilation.hpp"

namespace espalier::grammar {

// What commands have changed so far; kScopeValues nodes, as RuleRecord::values has them for kRuleScope.
struct RoofScope {
    Node values[kScopeValues];
    bool plain = true;
};
RoofScope plainScope(Graph& g);
// A command before a shape; reports what it doesn't take.
void applyCommand(Compilation& c, const CommandInfo& info, const Element& e, Env& env, RoofScope& scope);

// A block's kind and flags into `r`, its numbers behind `roots`; false where a mistake in how it is written was
// reported.
bool lowerBlock(Compilation& c, const BlockInfo& info, const Element& e, Env& env, RuleRecord& r,
                std::vector<Node>& roots);

// Marks the Repeats that stay one record of many cells. All rules are there, without mistakes.
void markGrids(Compilation& c);
// Marks successors that are terminals already (kSuccessorTerminal).
void markTerminals(Compilation& c);

}  // namespace espalier::grammar
