// Replaces shapes of roofs by their rules' shapes until terminals are left (Buron 2013 §3, §4), on GPU and CPU alike.
// In: a shape. Out: shapes for the next wave, grids of terminals, regions that Join makes. A lane goes on with the last
// successor itself, and ends with at most one grid, so that grids are written behind the loop over rules: a software
// device goes through all code of a loop each time, used or not.
#ifndef ESPALIER_SHARED_ROOF_EXPAND_H
#define ESPALIER_SHARED_ROOF_EXPAND_H
#include "shaders/shared/roof_cells.h"
#include "shaders/shared/roof_rules.h"
#include "shaders/shared/roof_tables.h"

ESPALIER_BEGIN

// What a rule's shapes are handed to: the last one is kept to go on with, those before it are queued.
struct RoofHand {
    RoofScope kept;
    uint has;
    uint mesh;   // of a kept shape that is a terminal already, else kNoIndex
};

// What a lane adds to the status.
struct RoofTally {
    uint touched, whole, terminals, stopped, deep;
    uvec2 hash;
};
FN RoofTally emptyTally() {
    RoofTally t = {};
    t.touched = 0u;
    t.whole = 0u;
    t.terminals = 0u;
    t.stopped = 0u;
    t.deep = 0u;
    t.hash = uvec2(0u, 0u);
    return t;
}

// Where a grid of so many rows goes.
struct RoofPlace {
    uint grid, row;
};
#ifdef __cplusplus
inline RoofPlace takePlace(RoofEnv env, uint rows) {
    return {roofAdd(env.status.v[0].grids, 1u), rows != 0u ? roofAdd(env.status.v[0].rows, rows) : 0u};
}
inline void addTally(RoofStatus& to, const RoofTally& t) {
    roofAdd(to.touched, t.touched);
    roofAdd(to.whole, t.whole);
    roofAdd(to.terminals, t.terminals);
    roofAdd(to.stopped, t.stopped);
    roofAdd(to.deep, t.deep);
    roofAdd(to.hash[0], t.hash.x);
    roofAdd(to.hash[1], t.hash.y);
}
#else
// Each lane for itself: lanes that part and would have to meet again between a sum and its use may not.
RoofPlace takePlace(RoofEnv env, uint rows) {
    return RoofPlace(atomicAdd(env.status.v[0].grids, 1u), rows != 0u ? atomicAdd(env.status.v[0].rows, rows) : 0u);
}
// The lanes of a subgroup together.
void addTally(RoofEnv env, RoofTally t) {
    uvec2 cells = subgroupAdd(uvec2(t.touched, t.whole));
    uvec3 shapes = subgroupAdd(uvec3(t.terminals, t.stopped, t.deep));
    uvec2 hash = subgroupAdd(t.hash);
    if (!subgroupElect()) return;
    atomicAdd(env.status.v[0].touched, cells.x);
    atomicAdd(env.status.v[0].whole, cells.y);
    if (shapes.x != 0u) atomicAdd(env.status.v[0].terminals, shapes.x);
    if (shapes.y != 0u) atomicAdd(env.status.v[0].stopped, shapes.y);
    if (shapes.z != 0u) atomicAdd(env.status.v[0].deep, shapes.z);
    atomicAdd(env.status.v[0].hash[0], hash.x);
    atomicAdd(env.status.v[0].hash[1], hash.y);
}
#endif

// How many shapes of this wave are derived. A wave that is too wide is gone through for the sake of what it asks for, but
// where rules lead on and on that would take time without end and tell nothing.
FN uint shapesToDerive(RoofEnv env) {
    uint count = env.waves.v[env.wave].count;
    uint times = env.status.v[0].deep != 0u ? 1u : 8u;
    if (count > times * env.shapeRoom) return 0u;
    return count < env.shapeRoom ? count : env.shapeRoom;
}

FN void queueShape(RoofEnv env, RoofScope shape) {
    uint at = roofAdd(env.waves.v[env.wave + 1u].count, 1u);
    if (at < env.shapeRoom) {
        writeRoofScope(env.next, at, shape);
        if ((at & (kRoofGroup - 1u)) == 0u) roofAdd(env.waves.v[env.wave + 1u].groups[0], 1u);
    }
}

// Gives `shape` to a successor. number: tells apart shapes of one part. A shape on another atom than its parent's is
// queued, since a lane reads one atom.
FN void handOn(MACHINE_PARAM RoofEnv env, SuccessorRecord s, RoofScope parent, RoofScope shape, uint number, INOUT(RoofHand) hand) {
    runRoofCode(MACHINE env, s.code);
    shape.symbol = s.symbol;
    shape.marks += 1u;
    shape.key = childKey(parent.key, s.nameHash, s.ordinal);
    if (number != 0u) shape.key = mix64(shape.key + u64(number));
    for (uint a = 0u; a < kMaxArgs; ++a) shape.args[a] = valueOf(MACHINE s.args[a]);
    bool elsewhere = shape.atom != parent.atom;
    RoofScope queued = hand.kept;
    if (elsewhere) queued = shape;
    if (elsewhere || hand.has != 0u) queueShape(env, queued);
    if (!elsewhere) {
        hand.kept = shape;
        hand.has = 1u;
        hand.mesh = (s.flags & kSuccessorTerminal) != 0u ? (s.flags >> kSuccessorMesh) & 255u : kNoIndex;
    }
}

FN uint quantised(float x) { return uint(int(floorExact(limited(x * 128.0f, -2e9f, 2e9f)))); }

// The same whichever house grew with it, and wherever its records lie.
FN u64 hashOfGrid(RoofGrid g, vec2 plot) {
    u64 hash = mix64(g.key + mix64((u64(g.cells) << 32) | u64(g.mesh)));
    hash = mix64(hash + ((u64(quantised(g.origin.x) + quantised(plot.x)) << 32) | u64(quantised(g.origin.z) + quantised(plot.y))));
    return mix64(hash + ((u64(quantised(g.origin.y)) << 32) | u64(quantised(g.size.x * 16.0f))));
}

// The shape becomes a grid record: one cell, or those that a Repeat has left together.
FN void writeGrid(RoofEnv env, RoofScope shape, uint house, uint mesh, INOUT(RoofTally) tally) {
    if (shape.size.x < kLeastSide || shape.size.y < kLeastSide) return;
    uint rows = shape.cells >> 16u;
    bool many = shape.cells != 0x10001u;
    RoofPlace place = takePlace(env, many ? rows : 0u);
    if (!many) tally.terminals += 1u;
    if (place.grid >= env.gridRoom || (many && place.row + rows > env.rowRoom)) return;
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
    g.house = house | (env.plots.v[house].generation << 24u);
    g.firstRow = many ? place.row : kNoIndex;
    writeRoofGrid(env.grids, place.grid, g);
    u64 hash = hashOfGrid(g, plotOf(env, house));
    tally.hash = tally.hash + uvec2(uint(hash), uint(hash >> 32));
    uvec2 cells = uvec2(1u, 1u);
    if (many) cells = gridRuns(env, g);
    tally.touched += cells.x;
    tally.whole += cells.y;
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

// The parts that a rule's successors take, four bits each; any: bit 1 << part of all of them. trips: of the loops that
// hand one shape to all of them.
struct RoofParts {
    uint count, low, high, any, trips;
};
FN RoofParts partsOf(RoofEnv env, RuleRecord rule) {
    RoofParts p = {};
    p.count = rule.successorCount;
    p.low = 0u;
    p.high = 0u;
    p.any = 0u;
    p.trips = 0u;
    uint i = 0u;
    if (p.count != 0u) do {
            uint part = roofPartOf(env, rule.firstSuccessor + i) & 15u;
            p.trips += kRoofHandTrips;
            if (rule.kind == kRuleRepeat) p.trips += roofWordsOf(env, rule.firstSuccessor + i);
            if (part == 2u && rule.kind == kRuleJoin && joinsRoofOnly(env, rule.firstSuccessor + i)) part = kPartGoesOn;
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
FN bool mayTake(RoofEnv env, RuleRecord rule, RoofScope shape, uint firstPiece, uint k, uint part) {
    bool outline = (shape.marks & kShapeOutline) != 0u;
    switch (rule.kind) {
        case kRuleExtrude: return part == ((shape.marks & kShapeSegment) != 0u ? k : k >> 2u);
        case kRuleJoin: {
            if (rule.extrude == 0u || k < 2u) return part == k;
            if (part != 2u && part != kPartGoesOn) return false;
            RoofPiece piece = readPiece(env, firstPiece + k - 2u);
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

// Without these no piece of an outline is of use to a Join to the roof.
FN bool takesTops(RoofParts parts, uint style) {
    bool ridge = (style & kAtomRidged) != 0u;
    bool on = (style & kAtomGoesOn) != 0u;
    return ((parts.any >> 2u & 1u) != 0u && (ridge || on)) || ((parts.any >> kPartGoesOn & 1u) != 0u && on);
}

// Draws, inputs and code of the chosen rule; before it, where the symbol has a choice, those of the choice.
struct RoofChoice {
    RuleRecord rule;
    bool made;
};
FN RoofChoice chosenRule(MACHINE_PARAM RoofEnv env, RoofScope shape, RoofAtom atom, RoofRegion face) {
    SymbolRecord symbol = roofSymbol(env, shape.symbol);
    RoofChoice c = {};
    c.made = symbol.ruleCount != 0u;
    bool choosing = c.made && (symbol.select.count != 0u || symbol.selected.slot != kSlotImmediate || symbol.ruleCount > 1u);
    uint number = c.made ? symbol.firstRule : 0u;
    uint given = 0u;
    bool again;
    do {
        c.rule = roofRule(env, number);
        uint inputs = choosing ? symbol.inputs : c.rule.startInputs;
        if ((inputs & ~given) != 0u) giveShape(MACHINE shape, atom, face, plotOf(env, atom.house), inputs);
        given |= inputs;
        if ((kRoofUses & kRoofUsesLayers) != 0u)
            giveLayers(MACHINE env, shape, atom.house, choosing ? symbol.layers : c.rule.startLayers);
        drawRoofSites(MACHINE env, choosing ? symbol.firstSite : c.rule.firstSite,
                      choosing ? symbol.siteCount : c.rule.siteCount, shape.key);
        CodeRange code = c.rule.start;
        if (choosing) code = symbol.select;
        runRoofCode(MACHINE env, code);
        again = false;
        if (choosing) {
            int selected = selectedRule(MACHINE symbol);
            c.made = selected >= 0;
            number = symbol.firstRule + uint(selected);
            again = c.made;
        }
        choosing = false;
    } while (again);
    return c;
}

FN RoofNumbers numbersOf(MACHINE_PARAM RoofEnv env, RuleRecord rule) {
    RoofNumbers n = {};
    for (uint i = 0u; i < kMaxSplit; ++i) n.v[i] = 0.0f;
    uint numbers = rule.kind == kRuleSplit ? kMaxSplit : rule.kind >= kRuleScope ? kScopeValues
                   : rule.kind == kRuleJoin ? (rule.extrude != 0u ? 1u : 7u) : rule.kind == kRuleProject ? 6u
                   : rule.kind == kRuleRepeat ? 2u : rule.kind == kRuleExtrude ? 1u : 0u;
    uint at = 0u;
    if (numbers != 0u) do n.v[at] = valueOf(MACHINE roofValue(env, rule.values + at));
        while (++at < numbers);
    return n;
}

// Applies one rule. True: `shape` is now the successor to go on with. mesh: that of the terminal that `shape` has become.
FN bool replaceShape(MACHINE_PARAM RoofEnv env, RoofAtom atom, RoofRegion face, INOUT(RoofScope) shape, INOUT(uint) mesh,
                     INOUT(RoofTally) tally) {
    for (uint a = 0u; a < kMaxArgs; ++a) SET_SLOT(kSlotArg + a, shape.args[a]);
    RoofChoice choice = chosenRule(MACHINE env, shape, atom, face);
    if (!choice.made) return false;
    RuleRecord rule = choice.rule;
    RoofNumbers n = numbersOf(MACHINE env, rule);
    uint kind = roofKind(rule);
    RoofScope changed = shape;
    if (ROOF_USES(kRuleShape) || ROOF_USES(kRuleScope)) changed = applyScope(n, shape);
    if (kind == kRuleShape) {
        shape = changed;
        mesh = rule.extrude;
        return false;
    }
    RoofCells cells = {};
    cells.x = 1u;
    cells.y = 1u;
    if (rule.kind == kRuleRepeat) cells = cellsOf(rule, n, shape);
    uint count = childCount(rule, cells, shape, atom);
    RoofParts parts = partsOf(env, rule);
    if (kind == kRuleJoinRoof && count > 2u && !takesTops(parts, atom.style)) count = 2u;
    uint most = parts.count != 0u ? kMaxRoofTrips / parts.trips : 0u;
    if (most > kMaxRoofCells) most = kMaxRoofCells;
    bool last = (shape.marks & 255u) >= kMaxRoofDepth;
    if (last || (parts.count != 0u && count > most)) tally.stopped += 1u;
    if (last && count != 0u && parts.count != 0u) tally.deep += 1u;
    if (count > most) count = most;
    if (last) count = 0u;
    RoofHand hand = {};
    hand.kept = shape;
    hand.has = 0u;
    hand.mesh = kNoIndex;
    RoofPair pair = {};
    pair.child = 0u;
    pair.successor = 0u;
    pair = firstPair(env, rule, parts, shape, atom.firstPiece, count, pair);
    if (pair.child < count) do {
            uint k = pair.child;
            RoofChild c = childFor(shape, 0u);
            if (ROOF_USES(kRuleExtrude) && kind == kRuleExtrude) c = extruded(n, shape, k);
            if (ROOF_USES(kRuleJoinRoof) && kind == kRuleJoinRoof) c = joinedRoof(env, n, shape, atom, face, k);
            if (ROOF_USES(kRuleJoin) && kind == kRuleJoin) c = joined(env, n, shape, plotOf(env, atom.house), k);
            if (ROOF_USES(kRuleProject) && kind == kRuleProject) c = projected(n, shape);
            if (ROOF_USES(kRuleExplode) && kind == kRuleExplode) c = exploded(env, shape, atom, face, k);
            if (ROOF_USES(kRuleSplit) && kind == kRuleSplit) c = splitPart(rule, n, shape, k);
            if (ROOF_USES(kRuleRepeat) && kind == kRuleRepeat) c = repeated(rule, cells, shape, k);
            if (ROOF_USES(kRuleScope) && kind == kRuleScope) c.shape = changed;
            SuccessorRecord s = roofSuccessor(env, rule.firstSuccessor + pair.successor);
            if (c.made && c.part == s.part) handOn(MACHINE env, s, shape, c.shape, c.number, hand);
            pair.successor += 1u;
            if (pair.successor >= parts.count) {
                pair.successor = 0u;
                pair.child += 1u;
            }
            pair = firstPair(env, rule, parts, shape, atom.firstPiece, count, pair);
        } while (pair.child < count);
    shape = hand.kept;
    mesh = hand.mesh;
    return hand.has != 0u && mesh == kNoIndex;
}

// Derives a shape of this wave until only queued ones and at most one terminal are left. (Software devices go through a
// loop's body once more where the test comes first, and every rule's code for every shape: so tests come last, and what
// no successor takes isn't made.)
FN void deriveShape(RoofEnv env, uint at, INOUT(RoofTally) tally) {
#ifdef __cplusplus
    Machine machine = {};
#endif
    resetMachine(MACHINE_ONLY);
    bool first = env.wave == 0u;
    RoofScope shape = {};
    if (!first) shape = readScope(env, at);
    uint number = first ? env.starts.v[at] : shape.atom;
    RoofAtom atom = readAtom(env, number);
    if (first) shape = startShape(atom, number, env.startSymbol);
    RoofRegion face = readRegion(env, atom.region != kNoIndex ? atom.region : 0u);   // there is room for one in any town
    uint mesh = kNoIndex;
    bool goes;
    do goes = replaceShape(MACHINE env, atom, face, shape, mesh, tally);
    while (goes);
    if (mesh != kNoIndex) writeGrid(env, shape, atom.house, mesh, tally);
}

ESPALIER_END
#endif
