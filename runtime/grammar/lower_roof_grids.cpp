// In: the rules of a grammar of roofs. Out: which of its Repeats stay grids.
//
// A Repeat whose successors are terminals that ask for nothing but parameters and arguments stays one shape with many
// cells (Buron 2013 §4's Repeat(XY) of tiles): the expander hands its cells on to grids.
#include "runtime/grammar/lower_roof.hpp"
#include "runtime/grammar/rule_map_layout.hpp"

namespace espalier::grammar {
namespace {

// True if no code of the rule reads where the shape stands or which it is; turning needs a cell's own origin.
bool placeFree(const Compilation& c, const RuleRecord& r) {
    auto fixed = [](uint32_t slot) {
        const bool place = slot >= kSlotPos0 && slot < kSlotLocalNormal;
        const bool drawn = slot >= kSlotDraw && slot < kSlotPos0;  // layers too
        return !place && !drawn && slot != kSlotIndex && slot != kSlotCount;
    };
    auto codeFixed = [&](const CodeRange& range) {
        for (uint32_t i = 0; i < range.count; ++i) {
            const uint32_t bits = c.code.code[range.first + i].bits;
            for (uint32_t shift : {9u, 16u, 23u})
                if (!fixed((bits >> shift) & 127u)) return false;
        }
        return true;
    };
    if (!codeFixed(r.start)) return false;
    if (r.kind != kRuleList)
        for (uint32_t i = 0; i < kScopeValues; ++i) {
            const Value& v = c.roofValues[r.values + i];
            if (!fixed(v.slot)) return false;
            if ((i == 6 || i == 7) && (v.slot != kSlotImmediate || v.immediate != 0)) return false;
        }
    for (uint32_t i = 0; i < r.successorCount; ++i) {
        const SuccessorRecord& s = c.successors[r.firstSuccessor + i];
        if (!codeFixed(s.code)) return false;
        for (const Value& v : s.args)
            if (!fixed(v.slot)) return false;
    }
    return true;
}

bool contextFree(const Compilation& c, uint32_t symbol, uint32_t depth) {
    if (depth > 16) return false;
    const SymbolRecord& s = c.symbolRecords[symbol];
    if (s.ruleCount != 1 || s.select.count != 0 || s.selected.slot != kSlotImmediate) return false;
    const RuleRecord& r = c.rules[s.firstRule];
    if (r.kind != kRuleList && r.kind != kRuleScope && r.kind != kRuleShape) return false;
    if (r.siteCount != 0 || r.startLayers != 0 || !placeFree(c, r)) return false;
    for (uint32_t i = 0; i < r.successorCount; ++i)
        if (!contextFree(c, c.successors[r.firstSuccessor + i].symbol, depth + 1)) return false;
    return true;
}

}  // namespace

void markGrids(Compilation& c) {
    for (RuleRecord& r : c.rules) {
        if (r.kind != kRuleRepeat) continue;
        bool grid = true;
        for (uint32_t i = 0; i < r.successorCount; ++i)
            grid = grid && contextFree(c, c.successors[r.firstSuccessor + i].symbol, 0);
        if (grid) r.extrude |= kRepeatGrid;
    }
}

void markTerminals(Compilation& c) {
    for (SuccessorRecord& s : c.successors) {
        const SymbolRecord& symbol = c.symbolRecords[s.symbol];
        const RuleRecord& rule = c.rules[symbol.firstRule];
        if (symbol.ruleCount != 1 || rule.kind != kRuleShape || rule.params != 0) continue;
        if (isPlainTerminal(symbol, rule, std::span(c.roofValues).subspan(rule.values, kScopeValues)))
            s.flags |= kSuccessorTerminal | rule.extrude << kSuccessorMesh;
    }
}

}  // namespace espalier::grammar
