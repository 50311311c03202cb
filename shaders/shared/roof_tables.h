// The rule map as kernels of roofs read it. A read by address is a loop over the lanes on software devices; of a uniform
// buffer it costs a fifth. So environment, map and its words are bound, and words beyond that read by address, by a
// kernel specialised to it.
#ifndef ESPALIER_SHARED_ROOF_TABLES_H
#define ESPALIER_SHARED_ROOF_TABLES_H
#include "records/rule_map.h"
#include "shaders/shared/roof_lane.h"

ESPALIER_BEGIN

CONST_UINT(kUniformMapWords, 16384u);

#ifdef __cplusplus
CONST_UINT(kRoofUses, kRoofUsesAll);
#define ROOF_USES(kind) true
FN SymbolRecord roofSymbol(LANE_PARAM uint i) { return ENV.map.v[0].symbols.v[i]; }
FN RuleRecord roofRule(LANE_PARAM uint i) { return ENV.map.v[0].rules.v[i]; }
FN SuccessorRecord roofSuccessor(LANE_PARAM uint i) { return ENV.map.v[0].successors.v[i]; }
FN uint roofPartOf(LANE_PARAM uint i) { return ENV.map.v[0].successors.v[i].part; }
FN uint roofWordsOf(LANE_PARAM uint i) { return ENV.map.v[0].successors.v[i].code.count; }
FN Value roofValue(LANE_PARAM uint i) { return ENV.map.v[0].values.v[i]; }
FN CodeWord roofCode(LANE_PARAM uint i) { return ENV.map.v[0].code.v[i]; }
FN uint roofSiteAt(LANE_PARAM uint i) { return ENV.map.v[0].sites.v[i]; }
#else
layout(constant_id = kConstantTablesByAddress) const uint kMapByAddress = 0u;
layout(constant_id = kConstantRoofUses) const uint kRoofUses = kRoofUsesAll;
#define ROOF_USES(kind) ((kRoofUses >> (kind) & 1u) != 0u)
layout(binding = 1, scalar) uniform Map { RuleMapRef roofMap; };
layout(binding = 2, scalar) uniform MapWords { uint mapWords[kUniformMapWords]; };

// Word i of a section of the map, which begins where symbols do.
#define MAP_WORD(section, i) \
    (kMapByAddress != 0u ? UintBuf(section).v[i] : mapWords[uint((uint64_t(section) - roofEnv.words) >> 2u) + (i)])
#define SYMBOL_WORD(i) MAP_WORD(roofMap.symbols, i)
#define RULE_WORD(i) MAP_WORD(roofMap.rules, i)
#define SUCCESSOR_WORD(i) MAP_WORD(roofMap.successors, i)
#define VALUE_WORD(i) MAP_WORD(roofMap.values, i)
#define CODE_WORD(i) MAP_WORD(roofMap.code, i)

// Compilers leave out the words of members that nobody asks for.
SymbolRecord roofSymbol(LANE_PARAM uint i) {
    SymbolRecord s = {};
    FILL_SymbolRecord(s, SYMBOL_WORD, i * kSymbolRecord_words)
    return s;
}
RuleRecord roofRule(LANE_PARAM uint i) {
    RuleRecord r = {};
    FILL_RuleRecord(r, RULE_WORD, i * kRuleRecord_words)
    return r;
}
SuccessorRecord roofSuccessor(LANE_PARAM uint i) {
    SuccessorRecord s = {};
    FILL_SuccessorRecord(s, SUCCESSOR_WORD, i * kSuccessorRecord_words)
    return s;
}
uint roofPartOf(LANE_PARAM uint i) { return SUCCESSOR_WORD(i * kSuccessorRecord_words + kSuccessorRecord_part); }
uint roofWordsOf(LANE_PARAM uint i) {
    return SUCCESSOR_WORD(i * kSuccessorRecord_words + kSuccessorRecord_code + kCodeRange_count);
}
Value roofValue(LANE_PARAM uint i) {
    Value v = {};
    FILL_Value(v, VALUE_WORD, i * kValue_words)
    return v;
}
CodeWord roofCode(LANE_PARAM uint i) {
    CodeWord c = {};
    FILL_CodeWord(c, CODE_WORD, i * kCodeWord_words)
    return c;
}
uint roofSiteAt(LANE_PARAM uint i) { return MAP_WORD(roofMap.sites, i); }
#endif

// As runCode, and draws of sites. Software devices go through a loop's body once more where the test comes first.
FN void runRoofCode(LANE_PARAM CodeRange range) {
    uint i = 0u;
    if (range.count != 0u) do {
            CodeWord word = roofCode(MACHINE range.first + i);
            runWord(MACHINE word.bits, word.immediate);
        } while (++i < range.count);
}
FN void drawRoofSites(LANE_PARAM uint firstSite, uint siteCount, u64 key) {
    uint j = 0u;
    if (siteCount != 0u) do SET_SLOT(kSlotDraw + j, drawSite(roofSiteAt(MACHINE firstSite + j), key, key));
        while (++j < siteCount);
}

ESPALIER_END
#endif
