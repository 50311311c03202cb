// Replaces shapes of roofs by their rules' shapes until terminals are left (Buron 2013 §3, §4), on GPU and CPU alike.
// In: a shape. Out: shapes for the next wave, grids of terminals, regions that Join makes. A lane goes on with the last
// successor itself.
#ifndef ESPALIER_SHARED_ROOF_EXPAND_H
#define ESPALIER_SHARED_ROOF_EXPAND_H
#include "shaders/shared/roof_rules.h"

ESPALIER_BEGIN

// What a rule's shapes are handed to: the last one is kept to go on with, those before it are queued.
struct RoofHand {
    RoofScope kept;
    uint has;
};

FN void queueShape(RoofEnv env, RoofScope shape) {
    uint at = roofAdd(env.waves.v[env.wave + 1u].count, 1u);
    if (at < env.shapeRoom) {
        env.next.v[at] = shape;
        if ((at & (kRoofGroup - 1u)) == 0u) roofAdd(env.waves.v[env.wave + 1u].groups[0], 1u);
    }
}

// Gives `shape` to all successors of the rule's part. number: tells apart shapes of one part.
FN void handOn(MACHINE_PARAM RoofEnv env, RuleRecord rule, uint part, u64 parent, RoofScope shape, uint number,
               INOUT(RoofHand) hand) {
    for (uint i = 0u; i < rule.successorCount; ++i) {
        SuccessorRecord s = env.map.v[0].successors.v[rule.firstSuccessor + i];
        if (s.part != part) continue;
        if ((shape.marks & 255u) >= kMaxRoofDepth) {
            roofAdd(env.status.v[0].stopped, 1u);
            continue;
        }
        runCode(MACHINE env.map.v[0].code, s.code);
        if (hand.has != 0u) queueShape(env, hand.kept);
        hand.kept = shape;
        hand.kept.symbol = s.symbol;
        hand.kept.marks += 1u;
        hand.kept.key = childKey(parent, s.nameHash, s.ordinal);
        if (number != 0u) hand.kept.key = mix64(hand.kept.key + u64(number));
        for (uint a = 0u; a < kMaxArgs; ++a) hand.kept.args[a] = valueOf(MACHINE s.args[a]);
        hand.has = 1u;
    }
}

FN uint quantised(float x) { return uint(int(floorExact(limited(x * 128.0f, -2e9f, 2e9f)))); }

// The shape becomes a grid record: one cell, or those that a Repeat has left together.
FN void writeGrid(RoofEnv env, RoofScope shape, uint mesh) {
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
    uint house = env.atoms.v[shape.atom].house;
    g.house = house | (env.generations.v[house] << 24u);
    g.firstRow = firstRow;
    env.grids.v[at] = g;
    u64 hash = mix64(shape.key + mix64((u64(shape.cells) << 32) | u64(g.mesh)));
    hash = mix64(hash + ((u64(quantised(g.origin.x)) << 32) | u64(quantised(g.origin.z))));
    hash = mix64(hash + ((u64(quantised(g.origin.y)) << 32) | u64(quantised(g.size.x * 16.0f))));
    roofAdd(env.status.v[0].hash[0], uint(hash));
    roofAdd(env.status.v[0].hash[1], uint(hash >> 32));
}

FN uint childCount(RoofEnv env, RuleRecord rule, RoofCells cells, RoofScope shape) {
    bool segment = (shape.marks & kShapeSegment) != 0u;
    bool outline = (shape.marks & kShapeOutline) != 0u;
    uint pieces = 0u;
    uint region = kNoIndex;
    if (rule.kind == kRuleJoin || outline) {
        pieces = env.atoms.v[shape.atom].pieceCount;
        region = env.atoms.v[shape.atom].region;
    }
    switch (rule.kind) {
        case kRuleExtrude: return segment ? 2u : 5u;
        case kRuleJoin:
            if (rule.extrude == 0u) return 3u;
            return region == kNoIndex || (shape.marks & kShapeTop) != 0u ? 0u : 2u + pieces;
        case kRuleExplode: return outline ? 2u + pieces : 5u;
        case kRuleSplit: return kMaxSplit;
        case kRuleRepeat: return (rule.extrude & kRepeatGrid) != 0u ? 1u : cells.x * cells.y;
        case kRuleNull: return 0u;
        default: return 1u;
    }
}

// Applies one rule. True: `shape` is now the successor to go on with.
FN bool replaceShape(MACHINE_PARAM RoofEnv env, INOUT(RoofScope) shape) {
    SymbolRecord symbol = env.map.v[0].symbols.v[shape.symbol];
    for (uint a = 0u; a < kMaxArgs; ++a) SLOT(kSlotArg + a) = shape.args[a];
    bool given = symbol.inputs != 0u;
    if (given) giveShape(MACHINE env, shape);
    giveLayers(MACHINE env, shape, symbol.layers);
    drawSites(MACHINE env.map.v[0].sites, symbol.firstSite, symbol.siteCount, shape.key, shape.key);
    runCode(MACHINE env.map.v[0].code, symbol.select);
    int chosen = symbol.ruleCount == 0u ? -1 : selectedRule(MACHINE symbol);
    if (chosen < 0) return false;
    RuleRecord rule = env.map.v[0].rules.v[symbol.firstRule + uint(chosen)];
    if (!given && rule.startInputs != 0u) giveShape(MACHINE env, shape);
    giveLayers(MACHINE env, shape, rule.startLayers & ~symbol.layers);
    drawSites(MACHINE env.map.v[0].sites, rule.firstSite, rule.siteCount, shape.key, shape.key);
    runCode(MACHINE env.map.v[0].code, rule.start);
    RoofNumbers n;
    uint numbers = rule.kind == kRuleSplit ? kMaxSplit : rule.kind >= kRuleScope ? kScopeValues
                   : rule.kind == kRuleJoin ? 7u : rule.kind == kRuleProject ? 6u : rule.kind == kRuleRepeat ? 2u
                   : rule.kind == kRuleExtrude ? 1u : 0u;
    for (uint i = 0u; i < kMaxSplit; ++i) n.v[i] = 0.0f;
    for (uint i = 0u; i < numbers; ++i) n.v[i] = valueOf(MACHINE env.map.v[0].values.v[rule.values + i]);
    if (rule.kind == kRuleShape) {
        writeGrid(env, applyScope(n, shape), rule.extrude);
        return false;
    }
    RoofCells cells;
    cells.x = 1u;
    cells.y = 1u;
    if (rule.kind == kRuleRepeat) cells = cellsOf(rule, n, shape);
    uint count = childCount(env, rule, cells, shape);
    if (count > kMaxRoofCells) {
        roofAdd(env.status.v[0].stopped, 1u);
        count = kMaxRoofCells;
    }
    RoofHand hand;
    hand.kept = shape;
    hand.has = 0u;
    for (uint k = 0u; k < count; ++k) {
        RoofChild c = childFor(shape, 0u);
        switch (rule.kind) {
            case kRuleExtrude: c = extruded(n, shape, k); break;
            case kRuleJoin:
                if (rule.extrude != 0u)
                    c = joinedRoof(env, n, shape, k);
                else
                    c = joined(env, n, shape, k);
                break;
            case kRuleProject: c = projected(n, shape); break;
            case kRuleExplode: c = exploded(env, shape, k); break;
            case kRuleSplit: c = splitPart(rule, n, shape, k); break;
            case kRuleRepeat: c = repeated(rule, cells, shape, k); break;
            case kRuleScope: c.shape = applyScope(n, shape); break;
            default: break;
        }
        if (c.made) handOn(MACHINE env, rule, c.part, shape.key, c.shape, c.number, hand);
    }
    shape = hand.kept;
    return hand.has != 0u;
}

// Derives a shape of this wave until only queued ones are left.
FN void deriveShape(RoofEnv env, uint at) {
#ifdef __cplusplus
    Machine machine;
#endif
    resetMachine(MACHINE_ONLY);
    RoofScope shape = env.shapes.v[at];
    bool goes = true;
    while (goes) goes = replaceShape(MACHINE env, shape);
}

ESPALIER_END
#endif
