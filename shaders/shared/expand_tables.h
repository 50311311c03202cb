// Rule maps packed for the loops of expansion. A read from memory is what costs there, so each table holds what one
// stage needs in as few words as it takes. Packed anew on the device at the start of each growth: parameters change
// rule maps all the time.
#ifndef ESPALIER_SHARED_EXPAND_TABLES_H
#define ESPALIER_SHARED_EXPAND_TABLES_H
#include "records/expand_rows.h"
#include "records/rule_map.h"
#include "shaders/shared/constants.h"
#include "shaders/shared/expand_env.h"
#include "shaders/shared/interpreter.h"
#include "shaders/shared/leaf_pose.h"

ESPALIER_BEGIN

// Kernels that define ESPALIER_TABLES read the words from a uniform buffer, which on software devices costs half of
// a read by address. More words than that holds are read by address, by kernels specialised to it.
CONST_UINT(kUniformTableWords, 16384u);
#if !defined(__cplusplus) && defined(ESPALIER_TABLES)
layout(constant_id = kConstantTablesByAddress) const uint kTablesByAddress = 0u;
layout(binding = 0, scalar) uniform TableWords { uint tableWords[kUniformTableWords]; };
#define TABLE(i) (kTablesByAddress != 0u ? env.tables.v[i] : tableWords[i])
#else
#define TABLE(i) env.tables.v[i]
#endif

CONST_UINT(kRuleBlind, 1u << 24u);
CONST_UINT(kPackedContinues, 1u << 28u);
CONST_UINT(kPackedBark, 1u << 10u);
CONST_UINT(kPackedColoured, 1u << 11u);

FN uint packPair(uint low, uint high) { return (low & 0xFFFFu) | (high << 16u); }
FN uint packSlots(uint a, uint b, uint c, uint d) { return (a & 127u) | ((b & 127u) << 8u) | ((c & 127u) << 16u) | (d << 24u); }

// Each writes record i to its place in the table that begins at word `base`.
FN void packSymbol(SymbolRecordBuf from, UintBuf to, uint base, uint i) {
    SymbolRecord s = from.v[i];
    uint at = base + i * kSymbolRow_words;
    to.v[at + kSymbolRow_rules] = packPair(s.firstRule, s.ruleCount);
    to.v[at + kSymbolRow_select] = packPair(s.select.first, s.select.count);
    to.v[at + kSymbolRow_sites] = (s.firstSite & 0xFFFFu) | ((s.siteCount & 255u) << 16u) | (s.selected.slot << 24u);
    to.v[at + kSymbolRow_selected] = floatBitsToUint(s.selected.immediate);
    to.v[at + kSymbolRow_uses] = s.uses;
}

FN void packSuccessor(SuccessorRecordBuf from, UintBuf to, uint base, uint i) {
    SuccessorRecord s = from.v[i];
    uint at = base + i * kSuccessorRow_words;
    uint continues = (s.flags & kSuccessorContinues) != 0u ? kPackedContinues : 0u;
    to.v[at + kSuccessorRow_head] = (s.symbol & 0xFFFFu) | ((s.ordinal & 255u) << 16u) | ((s.argCount & 7u) << 24u) | continues;
    to.v[at + kSuccessorRow_nameHash] = s.nameHash;
    to.v[at + kSuccessorRow_code] = packPair(s.code.first, s.code.count);
    to.v[at + kSuccessorRow_slots] = packSlots(s.args[0].slot, s.args[1].slot, s.args[2].slot, s.args[3].slot & 127u);
    for (uint k = 0u; k < 4u; ++k) to.v[at + kSuccessorRow_args + k] = floatBitsToUint(from.v[i].args[k].immediate);
}

FN void packRule(RuleRecordBuf from, UintBuf to, uint base, uint i) {
    RuleRecord r = from.v[i];
    uint at = base + i * kRuleRow_words;
    bool blind = (r.arriveInputs | r.arriveLayers) == 0u;
    to.v[at + kRuleRow_head] = (r.kind & 3u) | ((r.successorCount & 63u) << 2u) | ((r.extrude & 255u) << 8u) |
               ((r.siteCount & 255u) << 16u) | (blind ? kRuleBlind : 0u);
    to.v[at + kRuleRow_links] = packPair(r.firstSuccessor, r.firstSite);
    to.v[at + kRuleRow_start] = packPair(r.start.first, r.start.count);
    to.v[at + kRuleRow_arrive] = packPair(r.arrive.first, r.arrive.count);
    to.v[at + kRuleRow_slots] = packSlots(r.distance.slot, r.angle.slot, r.condition.slot, (r.kind & 3u) == kRuleMarch ? r.values & 127u : 0u);
    to.v[at + kRuleRow_distance] = floatBitsToUint(r.distance.immediate);
    to.v[at + kRuleRow_angle] = floatBitsToUint(r.angle.immediate);
    to.v[at + kRuleRow_condition] = floatBitsToUint(r.condition.immediate);
    to.v[at + kRuleRow_uses] = r.params;
}

FN void packTerminal(TerminalRecordBuf from, UintBuf to, uint base, uint i) {
    TerminalRecord t = from.v[i];
    uint at = base + i * kTerminalRow_words;
    uint bark = (t.flags & kTerminalBark) != 0u ? kPackedBark : 0u;
    bool same = t.colour[0].slot == kSlotImmediate && t.colour[1].slot == kSlotImmediate && t.colour[2].slot == kSlotImmediate;
    uint coloured = same ? 0u : kPackedColoured;
    to.v[at + kTerminalRow_head] = (t.mesh & 255u) | ((t.smoothness & 3u) << 8u) | bark | coloured | ((t.gateSiteCount & 255u) << 16u) |
               (t.bodySiteCount << 24u);
    to.v[at + kTerminalRow_site] = t.site;
    to.v[at + kTerminalRow_gate] = packPair(t.gate.first, t.gate.count);
    to.v[at + kTerminalRow_body] = packPair(t.body.first, t.body.count);
    to.v[at + kTerminalRow_sites] = packPair(t.gateFirstSite, t.bodyFirstSite);
    to.v[at + kTerminalRow_slots] = packSlots(t.count.slot, t.size.slot, t.t.slot, t.lift.slot);
    to.v[at + kTerminalRow_moreSlots] = packSlots(t.turn.slot, t.pitch.slot, t.tint.slot, 0u);
    to.v[at + kTerminalRow_count] = floatBitsToUint(t.count.immediate);
    to.v[at + kTerminalRow_size] = floatBitsToUint(t.size.immediate);
    to.v[at + kTerminalRow_t] = floatBitsToUint(t.t.immediate);
    to.v[at + kTerminalRow_lift] = floatBitsToUint(t.lift.immediate);
    to.v[at + kTerminalRow_turn] = floatBitsToUint(t.turn.immediate);
    to.v[at + kTerminalRow_pitch] = floatBitsToUint(t.pitch.immediate);
    to.v[at + kTerminalRow_tint] = floatBitsToUint(t.tint.immediate);
    vec3 colour = vec3(t.colour[0].immediate, t.colour[1].immediate, t.colour[2].immediate);
    to.v[at + kTerminalRow_colour] = same ? packLeafTint(0.0f, colour, 0u) : packSlots(t.colour[0].slot, t.colour[1].slot, t.colour[2].slot, 0u);
    for (uint k = 0u; k < 3u; ++k) to.v[at + kTerminalRow_channels + k] = floatBitsToUint(from.v[i].colour[k].immediate);
}

FN void packExtrude(ExtrudeRecordBuf from, UintBuf to, uint base, uint i) {
    ExtrudeRecord e = from.v[i];
    uint at = base + i * kExtrudeRow_words;
    to.v[at + kExtrudeRow_terminals] = packPair(e.firstTerminal, e.terminalCount);
    to.v[at + kExtrudeRow_nameHash] = e.nameHash;
    to.v[at + kExtrudeRow_inputs] = e.inputs;
    to.v[at + kExtrudeRow_layers] = e.layers;
}

// A grammar's layers by the scene's numbers.
FN uint sceneLayers(RuleMapBuf grammars, uint g, uint layers) {
    uint scene = 0u;
    for (uint left = layers; left != 0u; left = left & (left - 1u)) {
        scene = scene | (1u << (grammars.v[g].layerOf[lowestBit(left)] & 15u));
    }
    return scene;
}

// Packs grammar `g`'s tables and gathers what its growth may ask of a place, all symbols and rules together: that is
// given once a step. Invocation `lane` of `lanes` packs its share; inputs and layers must be zero before.
FN void packGrammar(RuleMapBuf grammars, UintBuf tables, uint g, uint lane, uint lanes) {
    uint at = g * kGrammarTables_words;
    uint base = tables.v[at + kGrammarTables_symbols];
    for (uint i = lane; i < grammars.v[g].symbolCount; i += lanes) {
        packSymbol(grammars.v[g].symbols, tables, base, i);
        atomicOr(tables.v[at + kGrammarTables_inputs], grammars.v[g].symbols.v[i].inputs);
        atomicOr(tables.v[at + kGrammarTables_layers], grammars.v[g].symbols.v[i].layers);
        atomicOr(tables.v[at + kGrammarTables_sceneLayers], sceneLayers(grammars, g, grammars.v[g].symbols.v[i].layers));
    }
    base = tables.v[at + kGrammarTables_rules];
    for (uint i = lane; i < grammars.v[g].ruleCount; i += lanes) {
        packRule(grammars.v[g].rules, tables, base, i);
        RuleRecord r = grammars.v[g].rules.v[i];
        atomicOr(tables.v[at + kGrammarTables_inputs], r.startInputs | r.arriveInputs);
        atomicOr(tables.v[at + kGrammarTables_layers], r.startLayers | r.arriveLayers);
        atomicOr(tables.v[at + kGrammarTables_sceneLayers], sceneLayers(grammars, g, r.startLayers | r.arriveLayers));
    }
    base = tables.v[at + kGrammarTables_successors];
    for (uint i = lane; i < grammars.v[g].successorCount; i += lanes) packSuccessor(grammars.v[g].successors, tables, base, i);
    base = tables.v[at + kGrammarTables_terminals];
    for (uint i = lane; i < grammars.v[g].terminalCount; i += lanes) packTerminal(grammars.v[g].terminals, tables, base, i);
    base = tables.v[at + kGrammarTables_extrudes];
    for (uint i = lane; i < grammars.v[g].extrudeCount; i += lanes) {
        packExtrude(grammars.v[g].extrudes, tables, base, i);
        ExtrudeRecord e = grammars.v[g].extrudes.v[i];
        atomicOr(tables.v[at + kGrammarTables_extrudeInputs], e.inputs);
        atomicOr(tables.v[at + kGrammarTables_extrudeLayers], e.layers);
        atomicOr(tables.v[at + kGrammarTables_extrudeParams], e.params);
        atomicOr(tables.v[at + kGrammarTables_sceneLayers], sceneLayers(grammars, g, e.layers));
    }
    base = tables.v[at + kGrammarTables_code];
    for (uint i = lane; i < grammars.v[g].codeCount; i += lanes) {
        uint word = base + i * kCodeWord_words;
        tables.v[word + kCodeWord_bits] = grammars.v[g].code.v[i].bits;
        tables.v[word + kCodeWord_immediate] = floatBitsToUint(grammars.v[g].code.v[i].immediate);
    }
    base = tables.v[at + kGrammarTables_sites];
    for (uint i = lane; i < grammars.v[g].siteCount; i += lanes) tables.v[base + i] = grammars.v[g].sites.v[i];
}

// Where a grammar's tables begin.
struct TableBases {
    uint symbols, rules, successors, terminals, extrudes, code, sites;
};
FN TableBases basesOf(ExpandEnv env, uint grammar) {
    uint at = grammar * kGrammarTables_words;
    TableBases b = {};
    b.symbols = TABLE(at + kGrammarTables_symbols);
    b.rules = TABLE(at + kGrammarTables_rules);
    b.successors = TABLE(at + kGrammarTables_successors);
    b.terminals = TABLE(at + kGrammarTables_terminals);
    b.extrudes = TABLE(at + kGrammarTables_extrudes);
    b.code = TABLE(at + kGrammarTables_code);
    b.sites = TABLE(at + kGrammarTables_sites);
    return b;
}

// Runs the code that `pair` (first | count << 16) names; drawTable draws sites, see drawSite.
FN void runTable(MACHINE_PARAM ExpandEnv env, TableBases map, uint pair) {
    uint at = map.code + kCodeWord_words * (pair & 0xFFFFu);
    uint end = at + kCodeWord_words * (pair >> 16u);
    if (at >= end) return;
    do {   // software devices go through a body once more where the test comes first
        uint bits = TABLE(at + kGrammarTables_symbols);
        uint immediate = TABLE(at + kGrammarTables_rules);
        runWord(MACHINE bits, uintBitsToFloat(immediate));
        at += kCodeWord_words;
    } while (at < end);
}
FN void drawTable(MACHINE_PARAM ExpandEnv env, TableBases map, uint first, uint count, u64 key, u64 instanceKey) {
    uint j = 0u;
    if (count == 0u) return;
    do {
        uint site = TABLE(map.sites + first + j);
        SET_SLOT(kSlotDraw + j, drawSite(site, key, instanceKey));
    } while (++j < count);
}

// A value as the tables hold it.
FN float packedValue(MACHINE_PARAM uint slot, uint immediate) {
    return slot == kSlotImmediate ? uintBitsToFloat(immediate) : SLOT(slot);
}

ESPALIER_END
#endif
