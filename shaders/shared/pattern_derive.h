// Deriving symbols: scope, rule, room for the rule's sets; then the places of their pieces.
#ifndef ESPALIER_SHARED_PATTERN_DERIVE_H
#define ESPALIER_SHARED_PATTERN_DERIVE_H
#include "shaders/shared/pattern_merge.h"
#include "shaders/shared/pattern_query.h"

ESPALIER_BEGIN

// Runs a stretch of code where a turtle stands: draws, inputs, code. Arguments are in their slots.
FN void runThere(MACHINE_PARAM PatternEnv env, uint grammar, u64 key, uint firstSite, uint siteCount, uint inputs,
                 uint layers, CodeRange code, Turtle t, uint depth) {
    for (uint i = 0u; i < siteCount; ++i) {
        SET_SLOT(kSlotDraw + i, drawSite(env.grammars.v[grammar].sites.v[firstSite + i], key, key));
    }
    if ((inputs | layers) != 0u) {
        uint instance = t.w.walk.place >> 16u;
        Place p = {};
        p.position = t.w.position;
        p.normal = t.w.normal;
        p.heading = xAxisOf(t);
        p.uv = t.w.walk.uv;
        p.instance = instance;
        p.level = 0u;
        giveInputs(MACHINE env.surfaces, env.layers, env.grammars, frameOf(env.surfaces, instance, inputs), grammar,
                   inputs, layers, p, depth, 0u, 0.0f);
        askFields(MACHINE env, grammar, inputs, t);
    }
    runCode(MACHINE env.grammars.v[grammar].code, code);
}

// One scope command. False: the way leads off the surface.
FN bool applyScopeCommand(PatternEnv env, uint grammar, uint kind, vec3 v, INOUT(Turtle) t) {
    bool stands = true;
    if (kind == kOpSize) {
        t.size = v;
    } else if (kind != kOpTranslate) {
        t.turn = turnedAbout(t.turn, kind - kOpRotateX, v.x);
    } else {
        float distance = sqrtExact(v.x * v.x + v.y * v.y);
        t.lift = t.lift + v.z;
        if (distance > 0.0f) {
            vec3 along = turned(t.turn, vec3(v.x, v.y, 0.0f));
            float angle = atan2Exact(along.y, along.x);
            rotateHeading(t.w, angle);
            stands = walkAlong(env, grammar, env.grammars.v[grammar].guide, t.w, distance);
            rotateHeading(t.w, -angle);
        }
    }
    return stands;
}

FN vec3 rowsTimes(vec4 x, vec4 y, vec4 z, vec3 v) {
    return vec3(dot3(vec3(x.x, x.y, x.z), v), dot3(vec3(y.x, y.y, y.z), v), dot3(vec3(z.x, z.y, z.z), v));
}
// Where a turtle stands, in the world: unit axes of its scope and the place.
FN PatternPiece standAt(PatternEnv env, Turtle t) {
    uint instance = t.w.walk.place >> 16u;
    vec4 rx = env.surfaces.v[instance].toWorld[0];
    vec4 ry = env.surfaces.v[instance].toWorld[1];
    vec4 rz = env.surfaces.v[instance].toWorld[2];
    float k = rcpExact(surfaceScale(env.surfaces, instance));
    PatternPiece piece = {};
    piece.x = rowsTimes(rx, ry, rz, fromFrame(t.w, turned(t.turn, vec3(1.0f, 0.0f, 0.0f)))) * k;
    piece.y = rowsTimes(rx, ry, rz, fromFrame(t.w, turned(t.turn, vec3(0.0f, 0.0f, 1.0f)))) * k;
    piece.z = rowsTimes(rx, ry, rz, fromFrame(t.w, turned(t.turn, vec3(0.0f, 1.0f, 0.0f)))) * -k;
    vec3 up = rowsTimes(rx, ry, rz, t.w.normal) * k;
    piece.position = rowsTimes(rx, ry, rz, t.w.position) + vec3(rx.w, ry.w, rz.w) + up * t.lift;
    return piece;
}

// Where a segment begins or ends: as a production sees it that begins there, so that the next one begins as this one
// ends. On its way a walk has the normal of where it came from.
FN PatternPiece joinAt(PatternEnv env, Turtle t) {
    Turtle begun = {};
    turtleAt(env.surfaces, scopeOf(t), begun);
    return standAt(env, begun);
}
// Notes in piece i where a segment begins.
FN void markBegin(PatternEnv env, uint i, Turtle t) {
    PatternPiece begin = joinAt(env, t);
    env.pieces.v[i].position = begin.position;
    env.pieces.v[i].x = begin.x;
    env.pieces.v[i].y = begin.y;
}

// Goes along a part's chain. The production's arguments are in their slots, `key` is the production's. mark: piece that
// is told where the part says that a segment begins; kNoIndex: none.
FN bool followChain(MACHINE_PARAM PatternEnv env, uint grammar, u64 key, uint part, uint depth, uint mark,
                    INOUT(Turtle) t) {
    uint first = env.grammars.v[grammar].parts.v[part].firstOp;
    uint count = env.grammars.v[grammar].parts.v[part].opCount;
    uint begin = env.grammars.v[grammar].parts.v[part].begin;
    bool stands = true;
    for (uint i = 0u; i < count && stands; ++i) {
        if (mark != kNoIndex && i == begin) markBegin(env, mark, t);
        PatternOp op = env.grammars.v[grammar].ops.v[first + i];
        runThere(MACHINE env, grammar, key, op.firstSite, op.siteCount, op.inputs, op.layers, op.code, t, depth);
        vec3 v = vec3(valueOf(MACHINE op.values[0]), valueOf(MACHINE op.values[1]), valueOf(MACHINE op.values[2]));
        stands = applyScopeCommand(env, grammar, op.kind, v, t);
    }
    return stands;
}

// Where the chain has led: the part's own code. Its results are read from the machine directly afterwards.
FN void runPart(MACHINE_PARAM PatternEnv env, uint grammar, u64 key, PatternPart p, Turtle t, uint depth) {
    runThere(MACHINE env, grammar, key, p.firstSite, p.siteCount, p.inputs, p.layers, p.code, t, depth);
}

FN bool foundSetRoom(PatternEnv env) {
    return env.status.v[0].sets <= env.status.v[0].setRoom && env.status.v[0].pieces <= env.status.v[0].pieceRoom;
}

// What a part waits for, as a set among all.
FN uint setWaitedFor(uint firstSet, uint prereq) {
    return prereq == kNoIndex ? kNoIndex : ((firstSet + (prereq & ~kIfFallen)) | (prereq & kIfFallen));
}

// Room for the sets of shape i's rule, which are known by their numbers from now on. False: there is none.
FN bool makeSets(PatternEnv env, uint i, INOUT(PatternShape) shape) {
    RuleRecord rule = env.grammars.v[shape.grammar].rules.v[shape.rule];
    uint setCount = rule.extrude & 0xFFFFu;
    uint pieceCount = rule.extrude >> 16u;
    if (setCount == 0u) return true;
    uint firstSet = atomicAdd(env.status.v[0].sets, setCount);
    uint firstPiece = atomicAdd(env.status.v[0].pieces, pieceCount);
    if (firstSet + setCount > env.status.v[0].setRoom || firstPiece + pieceCount > env.status.v[0].pieceRoom) return false;
    atomicMax(env.status.v[0].setGroups[0], patternGroups(firstSet + setCount - env.status.v[0].firstSet));
    atomicMax(env.status.v[0].pieceGroups[0], patternGroups(firstPiece + pieceCount - env.status.v[0].firstPiece));
    shape.firstSet = firstSet;
    uint piece = firstPiece;
    uint last = kNoIndex;
    for (uint k = 0u; k < rule.successorCount; ++k) {
        uint at = rule.firstSuccessor + k;
        uint kind = env.grammars.v[shape.grammar].parts.v[at].kind;
        if (kind == kPartSymbol) continue;
        uint number = env.grammars.v[shape.grammar].parts.v[at].set;
        uint prereq = env.grammars.v[shape.grammar].parts.v[at].prereq;
        PatternSet s = {};
        s.key = shape.key;
        s.number = number;
        s.shape = i;
        s.prereq = setWaitedFor(firstSet, prereq);
        s.state = kSetOpen;
        s.met = kNoIndex;
        s.piece = piece;
        s.into = kNoIndex;
        if (number != last) env.sets.v[firstSet + number] = s;
        last = number;
        // Until it is placed, a piece tells its part in `mesh`.
        env.pieces.v[piece].mesh = at;
        env.pieces.v[piece].set = firstSet + number;
        piece = piece + 1u;
    }
    return true;
}

// Item i of the wave -> shape i.
FN void deriveItem(PatternEnv env, uint i) {
    PatternItem item = env.items.v[env.status.v[0].priority * env.status.v[0].itemRoom + i];
    uint grammar = item.grammar;
#ifdef __cplusplus
    Machine machine;
#endif
    resetMachine(MACHINE_ONLY);
    for (uint k = 0u; k < 4u; ++k) SET_SLOT(kSlotArg + k, item.args[k]);
    PatternShape shape = {};
    shape.key = item.key;
    shape.grammar = grammar;
    shape.rule = kNoIndex;
    shape.firstSet = kNoIndex;
    shape.depth = item.depth;
    shape.seed = item.seed;
    Turtle t = {};
    bool stands = turtleAt(env.surfaces, item.scope, t);
    uint symbol = item.symbol;
    if (item.part != kNoIndex) {
        PatternPart p = env.grammars.v[grammar].parts.v[item.part];
        stands = stands && followChain(MACHINE env, grammar, item.key, item.part, item.depth, kNoIndex, t);
        runPart(MACHINE env, grammar, item.key, p, t, item.depth);
        for (uint k = 0u; k < 4u; ++k) item.args[k] = valueOf(MACHINE p.args[k]);
        for (uint k = 0u; k < 4u; ++k) SET_SLOT(kSlotArg + k, item.args[k]);
        shape.key = childKey(item.key, p.nameHash, p.ordinal);
        symbol = p.symbol;
    }
    for (uint k = 0u; k < 4u; ++k) shape.args[k] = item.args[k];
    shape.scope = scopeOf(t);
    if (stands) {
        SymbolRecord s = env.grammars.v[grammar].symbols.v[symbol];
        runThere(MACHINE env, grammar, shape.key, s.firstSite, s.siteCount, s.inputs, s.layers, s.select, t, item.depth);
        int chosen = s.ruleCount == 0u ? -1 : selectedRule(MACHINE s);
        shape.rule = chosen < 0 ? kNoIndex : s.firstRule + uint(chosen);
    } else {
        atomicAdd(env.status.v[0].ended, 1u);
    }
    if (shape.rule != kNoIndex && !makeSets(env, i, shape)) shape.rule = kNoIndex;
    env.shapes.v[i] = shape;
}

// Sets the fate of a set that is still open. False: another has.
FN bool settle(PatternEnv env, uint set, uint state) {
    bool first = atomicExchange(env.sets.v[set].state, state) == kSetOpen;
    if (first) atomicAdd(env.status.v[0].decided, 1u);
    return first;
}

FN uint packPieceColour(float r, float g, float b) {
    if (r < 0.0f) return kNoIndex;
    uint x = uint(limited(r, 0.0f, 1.0f) * 1023.0f + 0.5f);
    uint y = uint(limited(g, 0.0f, 1.0f) * 1023.0f + 0.5f);
    uint z = uint(limited(b, 0.0f, 1.0f) * 1023.0f + 0.5f);
    return (x << 20u) | (y << 10u) | z;
}

// The sphere around all that a piece may meet.
FN vec4 sphereOf(PatternEnv env, PatternPiece p) {
    if ((p.mesh & kPieceLine) != 0u) {
        vec3 middle = p.position + p.x * 0.5f;
        // With half of what segments may lie above each other.
        float reach = sqrtExact(dot3(p.x, p.x)) * (0.5f + kMergeHeight) + 2.0f * sqrtExact(dot3(p.y, p.y));
        return vec4(middle.x, middle.y, middle.z, reach * 1.00001f);
    }
    if ((p.mesh & kPieceMerges) != 0u) return vec4(p.position.x, p.position.y, p.position.z, env.sets.v[p.set].reach);
    PatternMesh m = env.meshes.v[p.mesh & 0xFFFFu];
    vec3 c = p.position + p.x * m.centre.x + p.y * m.centre.y + p.z * m.centre.z;
    float side2 = larger(larger(dot3(p.x, p.x), dot3(p.y, p.y)), dot3(p.z, p.z));
    return vec4(c.x, c.y, c.z, m.radius * sqrtExact(side2) * 1.00001f);
}
FN uint classOf(float radius) {
    uint c = 0u;
    float most = kPieceLeast;
    while (c + 1u < kPieceClasses && most < radius) {
        most = most * 2.0f;
        c = c + 1u;
    }
    return c;
}
// The side of a class's cells: twice its largest radius.
FN float cellSide(uint c) { return kPieceLeast * 2.0f * uintBitsToFloat((127u + c) << 23u); }
FN uint cellAt3(PatternEnv env, uint layer, uint c, int x, int y, int z) {
    uint h = layer * 0x165667B1u ^ uint(x) * 0x9E3779B1u ^ uint(y) * 0x85EBCA77u ^ uint(z) * 0xC2B2AE3Du ^ c * 0x27D4EB2Fu;
    h = (h ^ (h >> 15u)) * 0x2C1B3C6Du;
    return (h ^ (h >> 13u)) & env.cellMask;
}
FN int cellIndex(float x, float side) { return int(floorExact(limited(x * rcpExact(side), -1e9f, 1e9f))); }

// The segment to where a turtle stands from where piece i has been told that it begins.
FN PatternPiece segmentTo(PatternEnv env, uint i, PatternPiece end, float width) {
    PatternPiece begin = env.pieces.v[i];
    PatternPiece piece = {};
    piece.position = begin.position;
    piece.x = end.position - begin.position;
    piece.y = begin.y * width;
    piece.z = vec3(uintBitsToFloat(packOct(begin.x)), uintBitsToFloat(packOct(end.x)), uintBitsToFloat(packOct(end.y)));
    return piece;
}

// Piece i of the wave: from its production's scope to its place.
FN void placePiece(PatternEnv env, uint i) {
    uint at = env.status.v[0].firstPiece + i;
    uint part = env.pieces.v[at].mesh;
    uint set = env.pieces.v[at].set;
    PatternShape shape = env.shapes.v[env.sets.v[set].shape];
#ifdef __cplusplus
    Machine machine;
#endif
    resetMachine(MACHINE_ONLY);
    for (uint k = 0u; k < 4u; ++k) SET_SLOT(kSlotArg + k, shape.args[k]);
    Turtle t = {};
    bool stands = turtleAt(env.surfaces, shape.scope, t);
    stands = stands && followChain(MACHINE env, shape.grammar, shape.key, part, shape.depth, at, t);
    PatternPart p = env.grammars.v[shape.grammar].parts.v[part];
    bool line = p.kind == kPartLine || p.kind == kPartMergedLine;
    runPart(MACHINE env, shape.grammar, shape.key, p, t, shape.depth);
    float r = valueOf(MACHINE p.args[0]);
    float g = valueOf(MACHINE p.args[1]);
    float b = valueOf(MACHINE p.args[2]);
    float reach = valueOf(MACHINE p.args[3]);
    float turn = valueOf(MACHINE p.args[4]);

    PatternPiece piece = {};
    if (line) {
        piece = segmentTo(env, at, joinAt(env, t), reach);
    } else {
        piece = standAt(env, t);
        piece.x = piece.x * t.size.x;
        piece.y = piece.y * t.size.z;
        piece.z = piece.z * t.size.y;
    }
    bool free = p.kind == kPartPlaced || p.kind == kPartLine;
    piece.mesh = p.mesh | (free ? kPieceFree : 0u) | (line ? kPieceLine : 0u) | (p.kind == kPartMerged ? kPieceMerges : 0u);
    piece.set = set;
    piece.colour = packPieceColour(r, g, b);
    piece.next = kNoIndex;
    if (line || p.kind == kPartMerged) {
        float s = 0.0f;
        float c = 0.0f;
        sinCosExact(limited(turn, 0.0f, kPi), s, c);
        env.sets.v[set].reach = reach;
        env.sets.v[set].turn = c;
        stands = stands && reach > 0.0f;
    }
    vec4 sphere = sphereOf(env, piece);
    // What is no size at all, or no number, is not to be seen.
    stands = stands && sphere.w > 0.0f && sphere.w < 1e6f && (!line || dot3(piece.x, piece.x) > 0.0f);
    if (!stands) settle(env, set, kSetFallen);
    if (stands && !free) {
        uint layer = layerOf(piece.mesh);
        uint c = classOf(sphere.w);
        float side = cellSide(c);
        uint cell = cellAt3(env, layer, c, cellIndex(sphere.x, side), cellIndex(sphere.y, side), cellIndex(sphere.z, side));
        atomicOr(env.status.v[0].classes[layer], 1u << c);
        piece.next = atomicExchange(env.cells.v[cell], at);
    }
    env.pieces.v[at] = piece;
}

ESPALIER_END
#endif
