// Rule maps packed for the loops of expansion. A read from memory is what costs there, so each table holds what one
// stage needs in as few words as it takes. Packed anew on the device at the start of each growth: parameters change
// rule maps all the time.
#ifndef ESPALIER_SHARED_EXPAND_TABLES_H
#define ESPALIER_SHARED_EXPAND_TABLES_H
#include "shaders/shared/expand_env.h"
#include "shaders/shared/interpreter.h"
#include "shaders/shared/leaf_pose.h"

ESPALIER_BEGIN

// Symbol, 5 words: 0 rules (first | count << 16), 1 code of `select` (first | count << 16),
//   2 first site | sites << 16 | slot of `selected` << 24, 3 its immediate, 4 parameters
// Rule, 9 words: 0 kind | successors << 2 | extrude << 8 | sites << 16 | blind << 24,
//   1 first successor | first site << 16, 2 code of `start`, 3 code of `arrive`,
//   4 slots of distance | angle << 8 | condition << 16, 5 to 7 their immediates, 8 parameters.
//   blind: the condition asks nothing of the place.
// Successor, 8 words: 0 symbol | ordinal << 16 | arguments << 24 | continues << 28, 1 hash of the symbol's name,
//   2 code, 3 slots of the arguments, 4 to 7 their immediates
// Terminal, 18 words: 0 mesh | smoothness << 8 | bark << 10 | coloured << 11 | gate's sites << 16 | body's sites << 24, 1 site,
//   2 code of the gate, 3 code of the body, 4 first site of the gate | of the body << 16,
//   5 slots of count, size, t, lift, 6 of turn, pitch, tint, 7 to 13 immediates of these seven,
//   14 packed colour, or, of one that is coloured leaf by leaf, slots of red, green and blue, whose immediates are 15 to 17
// Extrude program, 4 words: 0 first terminal | terminals << 16, 1 hash of its name, 2 inputs, 3 layers
// Code, 2 words each as CodeWord. Sites, 1 word each.
CONST_UINT(kSymbolWords, 5u);
CONST_UINT(kRuleWords, 9u);
CONST_UINT(kSuccessorWords, 8u);
CONST_UINT(kTerminalWords, 18u);
CONST_UINT(kExtrudeWords, 4u);

// Kernels that define ESPALIER_TABLES read the words from a uniform buffer, which on software devices costs half of
// a read by address. More words than that holds are read by address, by kernels specialised to it.
CONST_UINT(kUniformTableWords, 16384u);
#if !defined(__cplusplus) && defined(ESPALIER_TABLES)
layout(constant_id = 0) const uint kTablesByAddress = 0u;
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
    uint at = base + i * kSymbolWords;
    to.v[at] = packPair(s.firstRule, s.ruleCount);
    to.v[at + 1u] = packPair(s.select.first, s.select.count);
    to.v[at + 2u] = (s.firstSite & 0xFFFFu) | ((s.siteCount & 255u) << 16u) | (s.selected.slot << 24u);
    to.v[at + 3u] = floatBitsToUint(s.selected.immediate);
    to.v[at + 4u] = s.uses;
}

FN void packSuccessor(SuccessorRecordBuf from, UintBuf to, uint base, uint i) {
    SuccessorRecord s = from.v[i];
    uint at = base + i * kSuccessorWords;
    uint continues = (s.flags & kSuccessorContinues) != 0u ? kPackedContinues : 0u;
    to.v[at] = (s.symbol & 0xFFFFu) | ((s.ordinal & 255u) << 16u) | ((s.argCount & 7u) << 24u) | continues;
    to.v[at + 1u] = s.nameHash;
    to.v[at + 2u] = packPair(s.code.first, s.code.count);
    to.v[at + 3u] = packSlots(s.args[0].slot, s.args[1].slot, s.args[2].slot, s.args[3].slot & 127u);
    for (uint k = 0u; k < 4u; ++k) to.v[at + 4u + k] = floatBitsToUint(from.v[i].args[k].immediate);
}

FN void packRule(RuleRecordBuf from, UintBuf to, uint base, uint i) {
    RuleRecord r = from.v[i];
    uint at = base + i * kRuleWords;
    bool blind = (r.arriveInputs | r.arriveLayers) == 0u;
    to.v[at] = (r.kind & 3u) | ((r.successorCount & 63u) << 2u) | ((r.extrude & 255u) << 8u) |
               ((r.siteCount & 255u) << 16u) | (blind ? kRuleBlind : 0u);
    to.v[at + 1u] = packPair(r.firstSuccessor, r.firstSite);
    to.v[at + 2u] = packPair(r.start.first, r.start.count);
    to.v[at + 3u] = packPair(r.arrive.first, r.arrive.count);
    to.v[at + 4u] = packSlots(r.distance.slot, r.angle.slot, r.condition.slot, (r.kind & 3u) == kRuleMarch ? r.values & 127u : 0u);
    to.v[at + 5u] = floatBitsToUint(r.distance.immediate);
    to.v[at + 6u] = floatBitsToUint(r.angle.immediate);
    to.v[at + 7u] = floatBitsToUint(r.condition.immediate);
    to.v[at + 8u] = r.params;
}

FN void packTerminal(TerminalRecordBuf from, UintBuf to, uint base, uint i) {
    TerminalRecord t = from.v[i];
    uint at = base + i * kTerminalWords;
    uint bark = (t.flags & kTerminalBark) != 0u ? kPackedBark : 0u;
    bool same = t.colour[0].slot == kSlotImmediate && t.colour[1].slot == kSlotImmediate && t.colour[2].slot == kSlotImmediate;
    uint coloured = same ? 0u : kPackedColoured;
    to.v[at] = (t.mesh & 255u) | ((t.smoothness & 3u) << 8u) | bark | coloured | ((t.gateSiteCount & 255u) << 16u) |
               (t.bodySiteCount << 24u);
    to.v[at + 1u] = t.site;
    to.v[at + 2u] = packPair(t.gate.first, t.gate.count);
    to.v[at + 3u] = packPair(t.body.first, t.body.count);
    to.v[at + 4u] = packPair(t.gateFirstSite, t.bodyFirstSite);
    to.v[at + 5u] = packSlots(t.count.slot, t.size.slot, t.t.slot, t.lift.slot);
    to.v[at + 6u] = packSlots(t.turn.slot, t.pitch.slot, t.tint.slot, 0u);
    to.v[at + 7u] = floatBitsToUint(t.count.immediate);
    to.v[at + 8u] = floatBitsToUint(t.size.immediate);
    to.v[at + 9u] = floatBitsToUint(t.t.immediate);
    to.v[at + 10u] = floatBitsToUint(t.lift.immediate);
    to.v[at + 11u] = floatBitsToUint(t.turn.immediate);
    to.v[at + 12u] = floatBitsToUint(t.pitch.immediate);
    to.v[at + 13u] = floatBitsToUint(t.tint.immediate);
    vec3 colour = vec3(t.colour[0].immediate, t.colour[1].immediate, t.colour[2].immediate);
    to.v[at + 14u] = same ? packLeafTint(0.0f, colour, 0u) : packSlots(t.colour[0].slot, t.colour[1].slot, t.colour[2].slot, 0u);
    for (uint k = 0u; k < 3u; ++k) to.v[at + 15u + k] = floatBitsToUint(from.v[i].colour[k].immediate);
}

FN void packExtrude(ExtrudeRecordBuf from, UintBuf to, uint base, uint i) {
    ExtrudeRecord e = from.v[i];
    uint at = base + i * kExtrudeWords;
    to.v[at] = packPair(e.firstTerminal, e.terminalCount);
    to.v[at + 1u] = e.nameHash;
    to.v[at + 2u] = e.inputs;
    to.v[at + 3u] = e.layers;
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
    uint at = g * kGrammarWords;
    uint base = tables.v[at];
    for (uint i = lane; i < grammars.v[g].symbolCount; i += lanes) {
        packSymbol(grammars.v[g].symbols, tables, base, i);
        atomicOr(tables.v[at + kTableInputs], grammars.v[g].symbols.v[i].inputs);
        atomicOr(tables.v[at + kTableLayers], grammars.v[g].symbols.v[i].layers);
        atomicOr(tables.v[at + kTableSceneLayers], sceneLayers(grammars, g, grammars.v[g].symbols.v[i].layers));
    }
    base = tables.v[at + 1u];
    for (uint i = lane; i < grammars.v[g].ruleCount; i += lanes) {
        packRule(grammars.v[g].rules, tables, base, i);
        RuleRecord r = grammars.v[g].rules.v[i];
        atomicOr(tables.v[at + kTableInputs], r.startInputs | r.arriveInputs);
        atomicOr(tables.v[at + kTableLayers], r.startLayers | r.arriveLayers);
        atomicOr(tables.v[at + kTableSceneLayers], sceneLayers(grammars, g, r.startLayers | r.arriveLayers));
    }
    base = tables.v[at + 2u];
    for (uint i = lane; i < grammars.v[g].successorCount; i += lanes) packSuccessor(grammars.v[g].successors, tables, base, i);
    base = tables.v[at + 3u];
    for (uint i = lane; i < grammars.v[g].terminalCount; i += lanes) packTerminal(grammars.v[g].terminals, tables, base, i);
    base = tables.v[at + 4u];
    for (uint i = lane; i < grammars.v[g].extrudeCount; i += lanes) {
        packExtrude(grammars.v[g].extrudes, tables, base, i);
        ExtrudeRecord e = grammars.v[g].extrudes.v[i];
        atomicOr(tables.v[at + kTableExtrudeInputs], e.inputs);
        atomicOr(tables.v[at + kTableExtrudeLayers], e.layers);
        atomicOr(tables.v[at + kTableExtrudeParams], e.params);
        atomicOr(tables.v[at + kTableSceneLayers], sceneLayers(grammars, g, e.layers));
    }
    base = tables.v[at + 5u];
    for (uint i = lane; i < grammars.v[g].codeCount; i += lanes) {
        tables.v[base + 2u * i] = grammars.v[g].code.v[i].bits;
        tables.v[base + 2u * i + 1u] = floatBitsToUint(grammars.v[g].code.v[i].immediate);
    }
    base = tables.v[at + 6u];
    for (uint i = lane; i < grammars.v[g].siteCount; i += lanes) tables.v[base + i] = grammars.v[g].sites.v[i];
}

// Where a grammar's tables begin.
struct TableBases {
    uint symbols, rules, successors, terminals, extrudes, code, sites;
};
FN TableBases basesOf(ExpandEnv env, uint grammar) {
    uint at = grammar * kGrammarWords;
    TableBases b;
    b.symbols = TABLE(at);
    b.rules = TABLE(at + 1u);
    b.successors = TABLE(at + 2u);
    b.terminals = TABLE(at + 3u);
    b.extrudes = TABLE(at + 4u);
    b.code = TABLE(at + 5u);
    b.sites = TABLE(at + 6u);
    return b;
}

// Runs the code that `pair` (first | count << 16) names; drawTable draws sites, see drawSite.
FN void runTable(MACHINE_PARAM ExpandEnv env, TableBases map, uint pair) {
    uint at = map.code + 2u * (pair & 0xFFFFu);
    uint end = at + 2u * (pair >> 16u);
    if (at >= end) return;
    do {   // software devices go through a body once more where the test comes first
        uint bits = TABLE(at);
        uint immediate = TABLE(at + 1u);
        runWord(MACHINE bits, uintBitsToFloat(immediate));
        at += 2u;
    } while (at < end);
}
FN void drawTable(MACHINE_PARAM ExpandEnv env, TableBases map, uint first, uint count, u64 key, u64 instanceKey) {
    uint j = 0u;
    if (count == 0u) return;
    do {
        uint site = TABLE(map.sites + first + j);
        SLOT(kSlotDraw + j) = drawSite(site, key, instanceKey);
    } while (++j < count);
}

// A value as the tables hold it.
FN float packedValue(MACHINE_PARAM uint slot, uint immediate) {
    return slot == kSlotImmediate ? uintBitsToFloat(immediate) : SLOT(slot);
}

ESPALIER_END
#endif
