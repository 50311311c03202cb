// The rule map as kernels of roofs read it. A read by address is a loop over the lanes on software devices; of a uniform
// buffer it costs a fifth. So environment, map and its words are bound, and words beyond that read by address, by a
// kernel specialised to it.
#ifndef ESPALIER_SHARED_ROOF_TABLES_H
#define ESPALIER_SHARED_ROOF_TABLES_H
#include "shaders/shared/interpreter.h"
#include "shaders/shared/roof_records.h"

ESPALIER_BEGIN

CONST_UINT(kUniformMapWords, 16384u);

#ifdef __cplusplus
CONST_UINT(kRoofUses, kRoofUsesAll);
#define ROOF_USES(kind) true
FN SymbolRecord roofSymbol(RoofEnv env, uint i) { return env.map.v[0].symbols.v[i]; }
FN RuleRecord roofRule(RoofEnv env, uint i) { return env.map.v[0].rules.v[i]; }
FN SuccessorRecord roofSuccessor(RoofEnv env, uint i) { return env.map.v[0].successors.v[i]; }
FN uint roofPartOf(RoofEnv env, uint i) { return env.map.v[0].successors.v[i].part; }
FN uint roofWordsOf(RoofEnv env, uint i) { return env.map.v[0].successors.v[i].code.count; }
FN Value roofValue(RoofEnv env, uint i) { return env.map.v[0].values.v[i]; }
FN CodeWord roofCode(RoofEnv env, uint i) { return env.map.v[0].code.v[i]; }
FN uint roofSiteAt(RoofEnv env, uint i) { return env.map.v[0].sites.v[i]; }
#else
layout(constant_id = 0) const uint kMapByAddress = 0u;
layout(constant_id = 1) const uint kRoofUses = kRoofUsesAll;
#define ROOF_USES(kind) ((kRoofUses >> (kind) & 1u) != 0u)
layout(binding = 0, scalar) uniform Environment { RoofEnv roofEnv; };
layout(binding = 1, scalar) uniform Map { RuleMapRef roofMap; };
layout(binding = 2, scalar) uniform MapWords { uint mapWords[kUniformMapWords]; };

// Word i of a section of the map, which begins where symbols do.
#define MAP_WORD(section, i) \
    (kMapByAddress != 0u ? UintBuf(section).v[i] : mapWords[uint((uint64_t(section) - roofEnv.words) >> 2u) + (i)])
Value mapValue(uint slot, uint immediate) { return Value(slot, uintBitsToFloat(immediate)); }

SymbolRecord roofSymbol(RoofEnv env, uint i) {
    uint at = 14u * i;
    SymbolRecord s;
    s.firstRule = MAP_WORD(roofMap.symbols, at + 2u);
    s.ruleCount = MAP_WORD(roofMap.symbols, at + 3u);
    s.select.first = MAP_WORD(roofMap.symbols, at + 4u);
    s.select.count = MAP_WORD(roofMap.symbols, at + 5u);
    s.selected = mapValue(MAP_WORD(roofMap.symbols, at + 6u), MAP_WORD(roofMap.symbols, at + 7u));
    s.firstSite = MAP_WORD(roofMap.symbols, at + 8u);
    s.siteCount = MAP_WORD(roofMap.symbols, at + 9u);
    s.inputs = MAP_WORD(roofMap.symbols, at + 10u);
    s.layers = MAP_WORD(roofMap.symbols, at + 11u);
    return s;
}
RuleRecord roofRule(RoofEnv env, uint i) {
    uint at = 22u * i;
    RuleRecord r;
    r.kind = MAP_WORD(roofMap.rules, at);
    r.firstSuccessor = MAP_WORD(roofMap.rules, at + 1u);
    r.successorCount = MAP_WORD(roofMap.rules, at + 2u);
    r.extrude = MAP_WORD(roofMap.rules, at + 3u);
    r.firstSite = MAP_WORD(roofMap.rules, at + 4u);
    r.siteCount = MAP_WORD(roofMap.rules, at + 5u);
    r.start.first = MAP_WORD(roofMap.rules, at + 6u);
    r.start.count = MAP_WORD(roofMap.rules, at + 7u);
    r.startInputs = MAP_WORD(roofMap.rules, at + 16u);
    r.startLayers = MAP_WORD(roofMap.rules, at + 17u);
    r.values = MAP_WORD(roofMap.rules, at + 21u);
    return r;
}
uint roofPartOf(RoofEnv env, uint i) { return MAP_WORD(roofMap.successors, 16u * i + 15u); }
uint roofWordsOf(RoofEnv env, uint i) { return MAP_WORD(roofMap.successors, 16u * i + 5u); }
SuccessorRecord roofSuccessor(RoofEnv env, uint i) {
    uint at = 16u * i;
    SuccessorRecord s;
    s.symbol = MAP_WORD(roofMap.successors, at);
    s.nameHash = MAP_WORD(roofMap.successors, at + 1u);
    s.ordinal = MAP_WORD(roofMap.successors, at + 2u);
    s.flags = MAP_WORD(roofMap.successors, at + 3u);
    s.code.first = MAP_WORD(roofMap.successors, at + 4u);
    s.code.count = MAP_WORD(roofMap.successors, at + 5u);
    for (uint a = 0u; a < 4u; ++a)
        s.args[a] = mapValue(MAP_WORD(roofMap.successors, at + 7u + 2u * a), MAP_WORD(roofMap.successors, at + 8u + 2u * a));
    s.part = MAP_WORD(roofMap.successors, at + 15u);
    return s;
}
Value roofValue(RoofEnv env, uint i) {
    return mapValue(MAP_WORD(roofMap.values, 2u * i), MAP_WORD(roofMap.values, 2u * i + 1u));
}
CodeWord roofCode(RoofEnv env, uint i) {
    return CodeWord(MAP_WORD(roofMap.code, 2u * i), uintBitsToFloat(MAP_WORD(roofMap.code, 2u * i + 1u)));
}
uint roofSiteAt(RoofEnv env, uint i) { return MAP_WORD(roofMap.sites, i); }
#endif

// As runCode, and draws of sites. Software devices go through a loop's body once more where the test comes first.
FN void runRoofCode(MACHINE_PARAM RoofEnv env, CodeRange range) {
    uint i = 0u;
    if (range.count != 0u) do {
            CodeWord word = roofCode(env, range.first + i);
            runWord(MACHINE word.bits, word.immediate);
        } while (++i < range.count);
}
FN void drawRoofSites(MACHINE_PARAM RoofEnv env, uint firstSite, uint siteCount, u64 key) {
    uint j = 0u;
    if (siteCount != 0u) do SLOT(kSlotDraw + j) = drawSite(roofSiteAt(env, firstSite + j), key, key);
        while (++j < siteCount);
}

ESPALIER_END
#endif
