// Which of a rule's shapes each of its successors takes: told before a shape is made.
#ifndef ESPALIER_SHARED_ROOF_PARTS_H
#define ESPALIER_SHARED_ROOF_PARTS_H
#include "shaders/shared/roof_tables.h"

ESPALIER_BEGIN

// What lies on top of a face and leads to none above has no face to join: successors that do nothing else there take only
// pieces that go on.
CONST_UINT(kPartGoesOn, 15u);
FN bool joinsRoofOnly(LANE_PARAM uint successor) {
    SymbolRecord symbol = roofSymbol(MACHINE roofSuccessor(MACHINE successor).symbol);
    if (symbol.ruleCount != 1u) return false;
    RuleRecord rule = roofRule(MACHINE symbol.firstRule);
    return rule.kind == kRuleJoin && rule.extrude != 0u;
}

// The parts that a rule's successors take, four bits each; any: bit 1 << part of all of them. trips: of the loops that
// hand one shape to all of them.
struct RoofParts {
    uint count, low, high, any, trips;
};
FN RoofParts partsOf(LANE_PARAM RuleRecord rule) {
    RoofParts p = {};
    p.count = rule.successorCount;
    p.low = 0u;
    p.high = 0u;
    p.any = 0u;
    p.trips = 0u;
    uint i = 0u;
    if (p.count != 0u) do {
            uint part = roofPartOf(MACHINE rule.firstSuccessor + i) & 15u;
            p.trips += kRoofHandTrips;
            if (rule.kind == kRuleRepeat) p.trips += roofWordsOf(MACHINE rule.firstSuccessor + i);
            if (part == 2u && rule.kind == kRuleJoin && joinsRoofOnly(MACHINE rule.firstSuccessor + i)) part = kPartGoesOn;
            p.any |= 1u << part;
            if (i < 8u)
                p.low |= part << (4u * i);
            else
                p.high |= part << (4u * i - 32u);
        } while (++i < p.count);
    return p;
}
FN uint partAt(RoofParts p, uint i) { return (i < 8u ? p.low >> (4u * i) : p.high >> (4u * i - 32u)) & 15u; }

// Whether child k of a rule may be there for successors of `part`: told without making it.
FN bool mayTake(LANE_PARAM uint k, uint part) {
    RoofScope shape = laneShape(MACHINE_ONLY);
    bool outline = (shape.marks & kShapeOutline) != 0u;
    switch (laneKind(MACHINE_ONLY)) {
        case kRuleExtrude: return part == ((shape.marks & kShapeSegment) != 0u ? k : k >> 2u);
        case kRuleJoinRoof: {
            if (k < 2u) return part == k;
            if (part != 2u && part != kPartGoesOn) return false;
            RoofPiece piece = ENV.pieces.v[ENV.atoms.v[shape.atom].firstPiece + k - 2u];
            return piece.upper != kNoIndex || (piece.kind == 3u && part == 2u);
        }
        case kRuleExplode: return outline && k >= 2u ? part >= 2u : part == k;
        case kRuleJoin:
        case kRuleSplit: return part == k;
        default: return part == 0u;
    }
}

// Pairs of a child and a successor that takes it, in order; (count, 0) is behind the last.
struct RoofPair {
    uint child, successor;
};
FN RoofPair pairBehind(RoofPair p, uint successors) {
    p.successor += 1u;
    if (p.successor >= successors) {
        p.successor = 0u;
        p.child += 1u;
    }
    return p;
}
FN RoofPair firstPair(LANE_PARAM RoofParts parts, uint count, RoofPair p) {
    bool found = false;
    if (p.child < count) do {
            found = mayTake(MACHINE p.child, partAt(parts, p.successor));
            if (!found) p = pairBehind(p, parts.count);
        } while (!found && p.child < count);
    return p;
}

// Without these no piece of an outline is of use to a Join to the roof.
FN bool takesTops(RoofParts parts, uint style) {
    bool ridge = (style & kAtomRidged) != 0u;
    bool on = (style & kAtomGoesOn) != 0u;
    return ((parts.any >> 2u & 1u) != 0u && (ridge || on)) || ((parts.any >> kPartGoesOn & 1u) != 0u && on);
}

ESPALIER_END
#endif
