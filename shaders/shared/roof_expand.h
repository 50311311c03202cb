// Replaces shapes of roofs by their rules' shapes until terminals are left (Buron 2013 §3, §4), on GPU and CPU alike.
// In: a shape. Out: shapes for the next wave, grids of terminals, regions that Join makes. A lane goes on with the last
// successor itself.
#ifndef ESPALIER_SHARED_ROOF_EXPAND_H
#define ESPALIER_SHARED_ROOF_EXPAND_H
#include "shaders/shared/roof_rules.h"
#include "shaders/shared/roof_tables.h"

ESPALIER_BEGIN

// What a rule's shapes are handed to: the last one is kept to go on with, those before it are queued.
struct RoofHand {
    RoofScope kept;
    uint has;
};

FN void queueShape(RoofEnv env, RoofScope shape) {
    uint at = roofAdd(env.waves.v[env.wave + 1u].count, 1u);
    if (at < env.shapeRoom) {
        writeScope(env, at, shape);
        if ((at & (kRoofGroup - 1u)) == 0u) roofAdd(env.waves.v[env.wave + 1u].groups[0], 1u);
    }
}

// Gives `shape` to a successor. number: tells apart shapes of one part.
FN void handOn(MACHINE_PARAM RoofEnv env, SuccessorRecord s, u64 parent, RoofScope shape, uint number, INOUT(RoofHand) hand) {
    if ((shape.marks & 255u) >= kMaxRoofDepth) {
        roofAdd(env.status.v[0].stopped, 1u);
        return;
    }
    runRoofCode(MACHINE env, s.code);
    if (hand.has != 0u) queueShape(env, hand.kept);
    hand.kept = shape;
    hand.kept.symbol = s.symbol;
    hand.kept.marks += 1u;
    hand.kept.key = childKey(parent, s.nameHash, s.ordinal);
    if (number != 0u) hand.kept.key = mix64(hand.kept.key + u64(number));
    for (uint a = 0u; a < kMaxArgs; ++a) hand.kept.args[a] = valueOf(MACHINE s.args[a]);
    hand.has = 1u;
}

FN uint quantised(float x) { return uint(int(floorExact(limited(x * 128.0f, -2e9f, 2e9f)))); }

// The shape becomes a grid record: one cell, or those that a Repeat has left together.
FN void writeGrid(RoofEnv env, RoofScope shape, uint house, uint mesh) {
    if (shape.size.x < kLeastSide || shape.size.y < kLeastSide) return;
    uint rows = shape.cells >> 16u;
    bool many = shape.cells != 0x10001u;
    uint at = roofAdd(env.status.v[0].grids, 1u);
    uint firstRow = many ? roofAdd(env.status.v[0].rows, rows) : kNoIndex;
    if (!many) roofAdd(env.status.v[0].terminals, 1u);
    if (at >= env.gridRoom || (many && firstRow + rows > env.rowRoom)) return;
    if ((at & (kRoofGroup - 1u)) == 0u) roofAdd(env.status.v[0].gridGroups[0], 1u);
    RoofGrid g;
    g.key = shape.key;
    g.origin = shape.origin;
    g.axisX = shape.axisX;
    g.axisY = shape.axisY;
    g.size = shape.size;
    g.step = shape.step;
    g.extent = shape.extent;
    g.taper = shape.taper;
    g.cells = shape.cells;
    g.mesh = mesh | ((shape.marks & kShapeRect) != 0u ? kGridRect : 0u) | ((shape.marks & kShapeBond) != 0u ? kGridBond : 0u) |
             ((shape.layers & 15u) << kGridDrop) | (((shape.layers >> 8u) & 15u) << kGridMoss);
    g.thickness = shape.thickness;
    g.colour = shape.colour;
    g.base = shape.base;
    g.shrink = rcpExact(shape.stretch);
    g.region = shape.region;
    g.atom = shape.atom;
    g.house = house | (env.generations.v[house] << 24u);
    g.firstRow = firstRow;
    writeGridRecord(env, at, g);
    u64 hash = mix64(shape.key + mix64((u64(shape.cells) << 32) | u64(g.mesh)));
    hash = mix64(hash + ((u64(quantised(g.origin.x)) << 32) | u64(quantised(g.origin.z))));
    hash = mix64(hash + ((u64(quantised(g.origin.y)) << 32) | u64(quantised(g.size.x * 16.0f))));
    roofAdd(env.status.v[0].hash[0], uint(hash));
    roofAdd(env.status.v[0].hash[1], uint(hash >> 32));
}

FN uint childCount(RuleRecord rule, RoofCells cells, RoofScope shape, RoofAtom atom) {
    bool segment = (shape.marks & kShapeSegment) != 0u;
    bool outline = (shape.marks & kShapeOutline) != 0u;
    switch (rule.kind) {
        case kRuleExtrude: return segment ? 2u : 5u;
        case kRuleJoin:
            if (rule.extrude == 0u) return 3u;
            return atom.region == kNoIndex || (shape.marks & kShapeTop) != 0u ? 0u : 2u + atom.pieceCount;
        case kRuleExplode: return outline ? 2u + atom.pieceCount : 5u;
        case kRuleSplit: return kMaxSplit;
        case kRuleRepeat: return (rule.extrude & kRepeatGrid) != 0u ? 1u : cells.x * cells.y;
        case kRuleNull: return 0u;
        default: return 1u;
    }
}

// What lies on top of a face and leads to none above has no face to join: successors that do nothing else there take only
// pieces that go on.
CONST_UINT(kPartGoesOn, 15u);
FN bool joinsRoofOnly(RoofEnv env, uint successor) {
    SymbolRecord symbol = roofSymbol(env, roofSuccessor(env, successor).symbol);
    if (symbol.ruleCount != 1u) return false;
    RuleRecord rule = roofRule(env, symbol.firstRule);
    return rule.kind == kRuleJoin && rule.extrude != 0u;
}

// The parts that a rule's successors take, four bits each.
struct RoofParts {
    uint count, low, high;
};
FN RoofParts partsOf(RoofEnv env, RuleRecord rule) {
    RoofParts p;
    p.count = rule.successorCount;
    p.low = 0u;
    p.high = 0u;
    uint i = 0u;
    if (p.count != 0u) do {
            uint part = roofPartOf(env, rule.firstSuccessor + i) & 15u;
            if (part == 2u && rule.kind == kRuleJoin && joinsRoofOnly(env, rule.firstSuccessor + i)) part = kPartGoesOn;
            if (i < 8u)
                p.low |= part << (4u * i);
            else
                p.high |= part << (4u * i - 32u);
        } while (++i < p.count);
    return p;
}
FN uint partAt(RoofParts p, uint i) { return (i < 8u ? p.low >> (4u * i) : p.high >> (4u * i - 32u)) & 15u; }

// Whether child k of a rule may be there for successors of `part`: told without making it.
FN bool mayTake(RoofEnv env, RuleRecord rule, RoofScope shape, uint firstPiece, uint k, uint part) {
    bool outline = (shape.marks & kShapeOutline) != 0u;
    switch (rule.kind) {
        case kRuleExtrude: return part == ((shape.marks & kShapeSegment) != 0u ? k : k >> 2u);
        case kRuleJoin: {
            if (rule.extrude == 0u || k < 2u) return part == k;
            if (part != 2u && part != kPartGoesOn) return false;
            PieceBrief piece = readPieceBrief(env, firstPiece + k - 2u);
            return piece.upper != kNoIndex || (piece.kind == 3u && part == 2u);
        }
        case kRuleExplode: return outline && k >= 2u ? part >= 2u : part == k;
        case kRuleSplit: return part == k;
        default: return part == 0u;
    }
}

// Pairs of a child and a successor that takes it, in order; (count, 0) is behind the last.
struct RoofPair {
    uint child, successor;
};
FN RoofPair firstPair(RoofEnv env, RuleRecord rule, RoofParts parts, RoofScope shape, uint firstPiece, uint count, RoofPair p) {
    bool found = false;
    if (p.child < count) do {
            found = mayTake(env, rule, shape, firstPiece, p.child, partAt(parts, p.successor));
            if (!found) {
                p.successor += 1u;
                if (p.successor >= parts.count) {
                    p.successor = 0u;
                    p.child += 1u;
                }
            }
        } while (!found && p.child < count);
    return p;
}

// Applies one rule. True: `shape` is now the successor to go on with.
FN bool replaceShape(MACHINE_PARAM RoofEnv env, INOUT(RoofScope) shape) {
    SymbolRecord symbol = roofSymbol(env, shape.symbol);
    RoofAtom atom = readAtom(env, shape.atom);
    for (uint a = 0u; a < kMaxArgs; ++a) SLOT(kSlotArg + a) = shape.args[a];
    // Twice the same: what the symbol's choice asks for, then what the chosen rule does.
    uint given = 0u;
    uint inputs = symbol.inputs;
    uint layers = symbol.layers;
    uint firstSite = symbol.firstSite;
    uint siteCount = symbol.siteCount;
    CodeRange code = symbol.select;
    uint chosen = kNoIndex;
    uint stage = 0u;
    RuleRecord rule;
    do {
        if ((inputs & ~given) != 0u) giveShape(MACHINE env, shape, atom, inputs);
        given |= inputs;
        if ((kRoofUses & kRoofUsesLayers) != 0u) giveLayers(MACHINE env, shape, atom.house, layers);
        drawRoofSites(MACHINE env, firstSite, siteCount, shape.key);
        runRoofCode(MACHINE env, code);
        if (stage == 0u) {
            int selected = symbol.ruleCount == 0u ? -1 : selectedRule(MACHINE symbol);
            if (selected >= 0) {
                chosen = symbol.firstRule + uint(selected);
                rule = roofRule(env, chosen);
                inputs = rule.startInputs;
                layers = rule.startLayers & ~symbol.layers;
                firstSite = rule.firstSite;
                siteCount = rule.siteCount;
                code = rule.start;
            }
        }
        stage += 1u;
    } while (stage < 2u && chosen != kNoIndex);
    if (chosen == kNoIndex) return false;
    RoofNumbers n;
    uint numbers = rule.kind == kRuleSplit ? kMaxSplit : rule.kind >= kRuleScope ? kScopeValues
                   : rule.kind == kRuleJoin ? 7u : rule.kind == kRuleProject ? 6u : rule.kind == kRuleRepeat ? 2u
                   : rule.kind == kRuleExtrude ? 1u : 0u;
    for (uint i = 0u; i < kMaxSplit; ++i) n.v[i] = 0.0f;
    uint at = 0u;
    if (numbers != 0u) do n.v[at] = valueOf(MACHINE roofValue(env, rule.values + at));
        while (++at < numbers);
    uint kind = roofKind(rule);
    RoofScope changed = shape;
    if (ROOF_USES(kRuleShape) || ROOF_USES(kRuleScope)) changed = applyScope(n, shape);
    if (kind == kRuleShape) {
        if (ROOF_USES(kRuleShape)) writeGrid(env, changed, atom.house, rule.extrude);
        return false;
    }
    RoofCells cells;
    cells.x = 1u;
    cells.y = 1u;
    if (rule.kind == kRuleRepeat) cells = cellsOf(rule, n, shape);
    uint count = childCount(rule, cells, shape, atom);
    if (count > kMaxRoofCells) {
        roofAdd(env.status.v[0].stopped, 1u);
        count = kMaxRoofCells;
    }
    RoofHand hand;
    hand.kept = shape;
    hand.has = 0u;
    RoofParts parts = partsOf(env, rule);
    if (parts.count == 0u) count = 0u;
    RoofPair pair;
    pair.child = 0u;
    pair.successor = 0u;
    pair = firstPair(env, rule, parts, shape, atom.firstPiece, count, pair);
    if (pair.child < count) do {
            uint k = pair.child;
            RoofChild c = childFor(shape, 0u);
            if (ROOF_USES(kRuleExtrude) && kind == kRuleExtrude) c = extruded(n, shape, k);
            if (ROOF_USES(kRuleJoinRoof) && kind == kRuleJoinRoof) c = joinedRoof(env, n, shape, atom, k);
            if (ROOF_USES(kRuleJoin) && kind == kRuleJoin) c = joined(env, n, shape, k);
            if (ROOF_USES(kRuleProject) && kind == kRuleProject) c = projected(n, shape);
            if (ROOF_USES(kRuleExplode) && kind == kRuleExplode) c = exploded(env, shape, atom, k);
            if (ROOF_USES(kRuleSplit) && kind == kRuleSplit) c = splitPart(rule, n, shape, k);
            if (ROOF_USES(kRuleRepeat) && kind == kRuleRepeat) c = repeated(rule, cells, shape, k);
            if (ROOF_USES(kRuleScope) && kind == kRuleScope) c.shape = changed;
            SuccessorRecord s = roofSuccessor(env, rule.firstSuccessor + pair.successor);
            if (c.made && c.part == s.part) handOn(MACHINE env, s, shape.key, c.shape, c.number, hand);
            pair.successor += 1u;
            if (pair.successor >= parts.count) {
                pair.successor = 0u;
                pair.child += 1u;
            }
            pair = firstPair(env, rule, parts, shape, atom.firstPiece, count, pair);
        } while (pair.child < count);
    shape = hand.kept;
    return hand.has != 0u;
}

// Derives a shape of this wave until only queued ones are left. (Software devices go through a loop's body once more where
// the test comes first, and every rule's code for every shape: so tests come last, and what no successor takes isn't made.)
FN void deriveShape(RoofEnv env, uint at) {
#ifdef __cplusplus
    Machine machine;
#endif
    resetMachine(MACHINE_ONLY);
    RoofScope shape = readScope(env, at);
    bool goes;
    do goes = replaceShape(MACHINE env, shape);
    while (goes);
}

ESPALIER_END
#endif
