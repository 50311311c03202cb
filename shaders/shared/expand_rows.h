// Rows of the packed tables that growth reads (expand_tables.h): each takes as few words as it can.
#ifndef ESPALIER_SHARED_EXPAND_ROWS_H
#define ESPALIER_SHARED_EXPAND_ROWS_H
#include "shaders/shared/language.h"

ESPALIER_BEGIN

// Where a grammar's packed tables lie among the words of all tables, what growth by it asks of places, and its width.
// One a grammar at the head of these words.
struct GrammarTables {
    uint symbols, rules, successors, terminals, extrudes, code, sites;   // indices of words
    float width;             // metres: the surface is taken as coarse as suits shapes of this width
    uint inputs, layers;     // of symbols and rules
    uint sceneLayers;        // by the scene's numbers, of terminals too
    uint extrudeInputs, extrudeLayers, extrudeParams;
    float avoid;             // metres that its stems stay away from others; 0: they don't
};
STATIC_SIZE(GrammarTables, 60);
RECORD_OFFSETS(GrammarTables)

struct SymbolRow {
    uint rules;              // first | count << 16
    uint select;             // its code: first | count << 16
    uint sites;              // first | count << 16 | slot of `selected` << 24
    float selected;          // immediate
    uint uses;               // parameters
};
RECORD_OFFSETS(SymbolRow)

struct RuleRow {
    uint head;               // kind | successors << 2 | extrude << 8 | sites << 16 | kRuleBlind
    uint links;              // first successor | first site << 16
    uint start, arrive;      // code
    uint slots;              // of distance | angle << 8 | condition << 16, then the blind part's, plus 1, << 24
    float distance, angle, condition;   // immediates
    uint uses;               // parameters
};
RECORD_OFFSETS(RuleRow)

struct SuccessorRow {
    uint head;               // symbol | ordinal << 16 | arguments << 24 | kPackedContinues
    uint nameHash;           // of the symbol
    uint code;
    uint slots;              // of the arguments
    float args[4];           // immediates
};
RECORD_OFFSETS(SuccessorRow)

struct TerminalRow {
    uint head;               // mesh | smoothness << 8 | kPackedBark | kPackedColoured | gate's sites << 16 | body's << 24
    uint site;
    uint gate, body;         // code
    uint sites;              // first of the gate | of the body << 16
    uint slots;              // of count, size, t, lift
    uint moreSlots;          // of turn, pitch, tint
    float count, size, t, lift, turn, pitch, tint;   // immediates
    uint colour;             // packed, or slots of red, green and blue where it differs from leaf to leaf
    float channels[3];       // immediates of these
};
RECORD_OFFSETS(TerminalRow)

struct ExtrudeRow {
    uint terminals;          // first | count << 16
    uint nameHash;
    uint inputs, layers;
};
RECORD_OFFSETS(ExtrudeRow)

ESPALIER_END
#endif
