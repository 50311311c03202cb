// Replaces shapes of roofs by their rules' shapes until terminals are left (Buron 2013 §3, §4), on GPU and CPU alike.
// In: a shape. Out: shapes for the next wave, grids of terminals, regions that Join makes. A lane goes on with the first
// successor itself, and ends with at most one grid. Its parts hand each other a few numbers only; the shapes are in the
// lane's memory (roof_lane.h).
#ifndef ESPALIER_SHARED_ROOF_EXPAND_H
#define ESPALIER_SHARED_ROOF_EXPAND_H
#include "shaders/shared/roof_parts.h"
#include "shaders/shared/roof_rules.h"

ESPALIER_BEGIN

// How many shapes of this wave are derived. A wave that is too wide is gone through for the sake of what it asks for, but
// where rules lead on and on that would take time without end and tell nothing.
FN uint shapesToDerive(LANE_ONLY_PARAM) {
    uint count = ENV.waves.v[WAVE].count;
    uint times = ENV.status.v[0].deep != 0u ? 1u : 8u;
    if (count > times * ENV.shapeRoom) return 0u;
    return count < ENV.shapeRoom ? count : ENV.shapeRoom;
}

FN void queueShape(LANE_PARAM RoofScope shape) {
    uint at = roofAdd(ENV.waves.v[WAVE + 1u].count, 1u);
    if (at >= ENV.shapeRoom) return;
    writeRoofScope(ENV.queues[(WAVE + 1u) & 1u], at, shape);
    if (at % kRoofGroup == 0u && at < kMostLanes) roofAdd(ENV.waves.v[WAVE + 1u].groups[0], 1u);
}

// What a lane is left with: a shape that waits for its rule, a terminal (its mesh) or, by kNoIndex, nothing.
CONST_UINT(kLeftShape, kNoIndex - 1u);

// Hands the lane's child to a successor, whose code has run: the lane goes on with the first one, the others are queued.
FN void handOn(LANE_PARAM SuccessorRecord s, RoofChild c, INOUT(uint) left) {
    RoofScope shape = laneChild(MACHINE_ONLY);
    shape.symbol = s.symbol;
    shape.marks += 1u;
    shape.key = childKey(shape.key, s.nameHash, s.ordinal);
    if (c.number != 0u) shape.key = mix64(shape.key + u64(c.number));
    for (uint a = 0u; a < kMaxArgs; ++a) shape.args[a] = valueOf(MACHINE s.args[a]);
    if (left != kNoIndex) {
        queueShape(MACHINE shape);
        return;
    }
    keepNext(MACHINE shape);
    left = (s.flags & kSuccessorTerminal) != 0u ? (s.flags >> kSuccessorMesh) & 255u : kLeftShape;
}

// Where a grid of so many rows goes. Each lane for itself: lanes that part and would have to meet again between a sum and
// its use may not.
struct RoofPlace {
    uint grid, row;
};
FN RoofPlace takePlace(LANE_PARAM uint rows) {
    RoofPlace p = {};
    p.grid = roofAdd(ENV.status.v[0].grids, 1u);
    p.row = rows != 0u ? roofAdd(ENV.status.v[0].rows, rows) : 0u;
    uint at = p.grid - ENV.status.v[0].firstGrid;
    if (at % kRoofGroup == 0u && at < kMostLanes) roofAdd(ENV.status.v[0].gridGroups[0], 1u);
    return p;
}

// The lane's shape becomes a grid record: one cell, or those that a Repeat has left together.
FN void writeGrid(LANE_PARAM uint mesh) {
    RoofScope shape = laneShape(MACHINE_ONLY);
    if (shape.size.x < kLeastSide || shape.size.y < kLeastSide) return;
    uint house = ENV.atoms.v[shape.atom].house;
    uint rows = shape.cells >> 16u;
    bool many = shape.cells != 0x10001u;
    RoofPlace place = takePlace(MACHINE many ? rows : 0u);
    if (place.grid >= ENV.gridRoom || (many && place.row + rows > ENV.rowRoom)) return;
    RoofGrid g = {};
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
    g.house = house | (ENV.plots.v[house].generation << 24u);
    g.firstRow = many ? place.row : kNoIndex;
    writeRoofGrid(ENV.grids, place.grid, g);
}

FN uint childCount(LANE_PARAM uint cells) {
    RoofScope shape = laneShape(MACHINE_ONLY);
    RoofAtom atom = ENV.atoms.v[shape.atom];
    switch (laneKind(MACHINE_ONLY)) {
        case kRuleExtrude: return (shape.marks & kShapeSegment) != 0u ? 2u : 5u;
        case kRuleJoin: return 3u;
        case kRuleJoinRoof: return atom.region == kNoIndex || (shape.marks & kShapeTop) != 0u ? 0u : 2u + atom.pieceCount;
        case kRuleExplode: return (shape.marks & kShapeOutline) != 0u ? 2u + atom.pieceCount : 5u;
        case kRuleSplit: return kMaxSplit;
        case kRuleRepeat: return (laneDetail(MACHINE_ONLY) & kRepeatGrid) != 0u ? 1u : (cells & 0xFFFFu) * (cells >> 16u);
        case kRuleNull: return 0u;
        default: return 1u;
    }
}

// What the machine is told, and runs, for the choice among a symbol's rules, and then for the rule.
struct RoofStage {
    uint inputs, layers, firstSite, siteCount;
    CodeRange code;
};
FN RoofStage stageOf(LANE_PARAM bool choosing, uint symbol, uint rule) {
    RoofStage stage = {};
    if (choosing) {
        SymbolRecord s = roofSymbol(MACHINE symbol);
        stage.inputs = s.inputs;
        stage.layers = s.layers;
        stage.firstSite = s.firstSite;
        stage.siteCount = s.siteCount;
        stage.code = s.select;
    } else {
        RuleRecord r = roofRule(MACHINE rule);
        stage.inputs = r.startInputs;
        stage.layers = r.startLayers;
        stage.firstSite = r.firstSite;
        stage.siteCount = r.siteCount;
        stage.code = r.start;
    }
    return stage;
}

// The number of the rule that applies to the lane's shape, whose code has run then; kNoIndex: none does.
FN uint chosenRule(LANE_ONLY_PARAM) {
    uint number = kNoIndex;
    bool choosing = false;
    {
        SymbolRecord symbol = roofSymbol(MACHINE laneShape(MACHINE_ONLY).symbol);
        if (symbol.ruleCount == 0u) return kNoIndex;
        choosing = symbol.select.count != 0u || symbol.selected.slot != kSlotImmediate || symbol.ruleCount > 1u;
        number = symbol.firstRule;
    }
    uint given = 0u;
    bool again;
    do {
        RoofStage stage = stageOf(MACHINE choosing, laneShape(MACHINE_ONLY).symbol, number);
        if ((stage.inputs & ~given) != 0u) giveShape(MACHINE stage.inputs);
        given |= stage.inputs;
        if ((kRoofUses & kRoofUsesLayers) != 0u) giveLayers(MACHINE stage.layers);
        drawRoofSites(MACHINE stage.firstSite, stage.siteCount, laneShape(MACHINE_ONLY).key);
        runRoofCode(MACHINE stage.code);
        again = false;
        if (choosing) {
            SymbolRecord symbol = roofSymbol(MACHINE laneShape(MACHINE_ONLY).symbol);
            int selected = selectedRule(MACHINE symbol);
            number = selected >= 0 ? symbol.firstRule + uint(selected) : kNoIndex;
            again = selected >= 0;
        }
        choosing = false;
    } while (again);
    return number;
}

FN void takeNumbers(LANE_PARAM uint first) {
    uint kind = laneKind(MACHINE_ONLY);
    uint numbers = kind == kRuleSplit ? kMaxSplit : kind == kRuleScope || kind == kRuleShape ? kScopeValues
                   : kind == kRuleJoin ? 7u : kind == kRuleProject ? 6u : kind == kRuleRepeat ? 2u
                   : kind == kRuleJoinRoof || kind == kRuleExtrude ? 1u : 0u;
    uint at = 0u;
    if (numbers != 0u) do SET_NUMBER(at, valueOf(MACHINE roofValue(MACHINE first + at)));
        while (++at < numbers);
}

// The rule's shape number k.
FN RoofChild childOf(LANE_PARAM uint cells, uint k) {
    uint kind = laneKind(MACHINE_ONLY);
    RoofChild c = {};
    c.made = false;
    if (ROOF_USES(kRuleExtrude) && kind == kRuleExtrude) c = extruded(MACHINE k);
    if (ROOF_USES(kRuleJoinRoof) && kind == kRuleJoinRoof) c = joinedRoof(MACHINE k);
    if (ROOF_USES(kRuleJoin) && kind == kRuleJoin) c = joined(MACHINE k);
    if (ROOF_USES(kRuleProject) && kind == kRuleProject) c = projected(MACHINE_ONLY);
    if (ROOF_USES(kRuleExplode) && kind == kRuleExplode) c = exploded(MACHINE k);
    if (ROOF_USES(kRuleSplit) && kind == kRuleSplit) c = splitPart(MACHINE k);
    if (ROOF_USES(kRuleRepeat) && kind == kRuleRepeat) c = repeated(MACHINE cells, k);
    if (kind == kRuleScope || kind == kRuleList) c = childFor(MACHINE laneShape(MACHINE_ONLY), 0u, 0u, true);
    return c;
}

// How many shapes a rule makes that `most` lets be handed on; what a limit ends is counted.
FN uint limitedCount(LANE_PARAM uint count, RoofParts parts) {
    bool tops = laneKind(MACHINE_ONLY) == kRuleJoinRoof && count > 2u;
    if (tops && !takesTops(parts, ENV.atoms.v[laneShape(MACHINE_ONLY).atom].style)) count = 2u;
    uint most = parts.count != 0u ? kMaxRoofTrips / parts.trips : 0u;
    if (most > kMaxRoofCells) most = kMaxRoofCells;
    bool last = (laneShape(MACHINE_ONLY).marks & 255u) >= kMaxRoofDepth;
    if (last || (parts.count != 0u && count > most)) roofAdd(ENV.status.v[0].stopped, 1u);
    if (last && count != 0u && parts.count != 0u) roofAdd(ENV.status.v[0].deep, 1u);
    return last ? 0u : count < most ? count : most;
}

// Applies one rule to the lane's shape. Returns what the lane is left with.
FN uint replaceShape(LANE_ONLY_PARAM) {
    for (uint a = 0u; a < kMaxArgs; ++a) SET_SLOT(kSlotArg + a, laneShape(MACHINE_ONLY).args[a]);
    uint number = chosenRule(MACHINE_ONLY);
    if (number == kNoIndex) return kNoIndex;
    RuleRecord rule = roofRule(MACHINE number);
    uint kind = roofKind(rule);
    keepRule(MACHINE kind, rule.extrude);
    takeNumbers(MACHINE rule.values);
    bool changes = kind == kRuleShape || kind == kRuleScope;
    if ((ROOF_USES(kRuleShape) || ROOF_USES(kRuleScope)) && changes) keepShape(MACHINE changedShape(MACHINE_ONLY));
    if (kind == kRuleShape) return rule.extrude;
    uint cells = 0u;
    if (ROOF_USES(kRuleRepeat) && kind == kRuleRepeat) cells = cellsOf(MACHINE_ONLY);
    RoofParts parts = partsOf(MACHINE rule);
    uint count = limitedCount(MACHINE childCount(MACHINE cells), parts);
    uint left = kNoIndex;
    RoofPair pair = {};
    pair.child = 0u;
    pair.successor = 0u;
    pair = firstPair(MACHINE parts, count, pair);
    if (pair.child < count) do {
            uint successor = rule.firstSuccessor + pair.successor;
            runRoofCode(MACHINE roofSuccessor(MACHINE successor).code);
            RoofChild c = childOf(MACHINE cells, pair.child);
            SuccessorRecord s = roofSuccessor(MACHINE successor);
            if (c.made && c.part == s.part) handOn(MACHINE s, c, left);
            pair = firstPair(MACHINE parts, count, pairBehind(pair, parts.count));
        } while (pair.child < count);
    if (left != kNoIndex) goOnWithNext(MACHINE_ONLY);
    return left;
}

// Derives a shape of this wave until only queued ones and at most one terminal are left. (Software devices go through a
// loop's body once more where the test comes first, and every rule's code for every shape: so tests come last, and what
// no successor takes isn't made.)
FN void deriveShape(LANE_PARAM uint at) {
    resetMachine(MACHINE_ONLY);
    RoofScope shape = {};
    if (WAVE != 0u) {
        shape = readRoofScope(ENV.queues[WAVE & 1u], at);
    } else {
        uint atom = ENV.starts.v[at];
        shape = startShape(ENV.atoms.v[atom], atom, ENV.startSymbol);
    }
    keepShape(MACHINE shape);
    uint left = kNoIndex;
    do left = replaceShape(MACHINE_ONLY);
    while (left == kLeftShape);
    if (left != kNoIndex) writeGrid(MACHINE left);
}

ESPALIER_END
#endif
