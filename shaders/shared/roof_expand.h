// Replaces shapes of roofs by their rules' shapes until terminals are left (Buron 2013 §3, §4), on GPU and CPU alike.
// In: a shape. Out: shapes for the next wave, grids of terminals, regions that Join makes. A lane goes on with the last
// successor itself.
#ifndef ESPALIER_SHARED_ROOF_EXPAND_H
#define ESPALIER_SHARED_ROOF_EXPAND_H
#include "shaders/shared/interpreter.h"
#include "shaders/shared/roof_records.h"

ESPALIER_BEGIN

#ifdef __cplusplus
inline uint roofAdd(uint& memory, uint value) { return __atomic_fetch_add(&memory, value, __ATOMIC_RELAXED); }
#else
#define roofAdd atomicAdd
#endif

CONST_FLOAT(kLeastSide, 1e-3f);   // metres: what is smaller vanishes
CONST_FLOAT(kLeastCell, 0.01f);

FN vec3 axisOf(vec3 v) { return unit3(v); }
FN vec3 upward() { return vec3(0.0f, 1.0f, 0.0f); }

// A point of a region's frame in the world, of a roof whose eave lies at `base`.
FN vec3 regionPoint(RoofRegion r, vec3 at, float base, float stretch) {
    vec3 d = r.axisA * at.x + r.axisB * at.y + r.axisC * at.z;
    return vec3(r.origin.x + d.x, base + d.y * stretch, r.origin.z + d.z);
}

FN void giveVector(MACHINE_PARAM uint slot, vec3 v) {
    SLOT(slot) = v.x;
    SLOT(slot + 1u) = v.y;
    SLOT(slot + 2u) = v.z;
}

// Fills the slots of rule_map.h for a shape.
FN void giveShape(MACHINE_PARAM RoofEnv env, RoofScope shape) {
    RoofAtom atom = env.atoms.v[shape.atom];
    giveVector(MACHINE kSlotPos0, shape.origin);
    giveVector(MACHINE kSlotPos1, shape.origin + shape.axisX * shape.size.x);
    giveVector(MACHINE kSlotLocalNormal, cross3(shape.axisX, shape.axisY));
    giveVector(MACHINE kSlotLocalTangent, shape.axisX);
    giveVector(MACHINE kSlotEaveTangent, atom.tangent);
    vec3 target1 = atom.foot;
    vec3 target2 = atom.foot;
    float start = 0.0f;
    if (atom.region != kNoIndex) {
        RoofRegion r = env.regions.v[atom.region];
        target1 = regionPoint(r, atom.target1, shape.base, shape.stretch);
        target2 = regionPoint(r, atom.target2, shape.base, shape.stretch);
        start = -r.low.x;
    }
    giveVector(MACHINE kSlotRoofPos1, target1);
    giveVector(MACHINE kSlotRoofPos2, target2);
    SLOT(kSlotRoofHeight) = atom.height;
    SLOT(kSlotRoofSlope) = atom.slope;
    SLOT(kSlotProjectHeight) = shape.projectHeight;
    SLOT(kSlotSizeX) = shape.size.x;
    SLOT(kSlotSizeY) = shape.size.y;
    SLOT(kSlotIndex) = float(shape.place & 0xFFFFu);
    SLOT(kSlotCount) = float(shape.place >> 16u);
    SLOT(kSlotEaveStart) = start;
    SLOT(kSlotEaveLength) = atom.eaveLength;
    SLOT(kSlotJoint) = float((shape.marks >> kShapeJoint) & 15u);
    SLOT(kSlotOwner) = (shape.marks & kShapeOwner) != 0u ? 1.0f : 0.0f;
    SLOT(kSlotFaceKind) = float(atom.kind);
    SLOT(kSlotTier) = float(atom.tier);
    SLOT(kSlotWallHeight) = atom.wallHeight;
    SLOT(kSlotHouseRandom) = atom.random;
    SLOT(kSlotHouseShape) = float(atom.style & 255u);
    SLOT(kSlotHouseMaterial) = float((atom.style >> 8u) & 255u);
    SLOT(kSlotHouseTinted) = float((atom.style >> 16u) & 1u);
    giveVector(MACHINE kSlotHouseColour, atom.colour);
    SLOT(kSlotCorners) = atom.corners.x;
    SLOT(kSlotCorners + 1u) = atom.corners.y;
}

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

// A rule's numbers, kept while its successors' code runs.
struct RoofNumbers {
    float v[kMaxSplit];
};
FN vec3 vectorOf(RoofNumbers n, uint i) { return vec3(n.v[i], n.v[i + 1u], n.v[i + 2u]); }

// One of the shapes that a rule makes. part: whose successors take it; number tells apart shapes of one part.
struct RoofChild {
    RoofScope shape;
    uint part, number;
    bool made;
};
FN RoofChild childFor(RoofScope shape, uint part) {
    RoofChild c;
    c.shape = shape;
    c.part = part;
    c.number = 0u;
    c.made = true;
    return c;
}

FN uint packColour(float r, float g, float b) {
    return uint(sqrtExact(limited(r, 0.0f, 1.0f)) * 255.0f + 0.5f) |
           (uint(sqrtExact(limited(g, 0.0f, 1.0f)) * 255.0f + 0.5f) << 8u) |
           (uint(sqrtExact(limited(b, 0.0f, 1.0f)) * 255.0f + 0.5f) << 16u);
}

// S, T, R, Tint, Colour of a rule. Negative sizes, tints and colours leave what there is.
FN RoofScope applyScope(RoofNumbers n, RoofScope shape) {
    vec3 size = vectorOf(n, 0u);
    vec3 move = vectorOf(n, 3u);
    float turn = n.v[6];
    float pitch = n.v[7];
    float tint = n.v[8];
    vec3 colour = vectorOf(n, 9u);
    vec3 normal = cross3(shape.axisX, shape.axisY);
    shape.origin = shape.origin + shape.axisX * move.x + shape.axisY * move.y + normal * move.z;
    if (size.x >= 0.0f) shape.size.x = size.x;
    if (size.y >= 0.0f) shape.size.y = size.y;
    if (size.z >= 0.0f) shape.thickness = size.z;
    float s;
    float c;
    if (turn != 0.0f) {
        sinCosExact(limited(turn, -100.0f, 100.0f), s, c);
        vec3 x = shape.axisX * c + shape.axisY * s;
        shape.axisY = axisOf(shape.axisY * c - shape.axisX * s);
        shape.axisX = axisOf(x);
    }
    if (pitch != 0.0f) {
        sinCosExact(limited(pitch, -100.0f, 100.0f), s, c);
        shape.axisY = axisOf(shape.axisY * c + cross3(shape.axisX, shape.axisY) * s);
    }
    if (tint >= 0.0f) shape.colour = (shape.colour & 0xFFFFFFu) | (uint(limited(tint, 0.0f, 1.0f) * 255.0f + 0.5f) << 24u);
    if (colour.x >= 0.0f) shape.colour = (shape.colour & 0xFF000000u) | packColour(colour.x, colour.y, colour.z);
    return shape;
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
    g.mesh = mesh | ((shape.marks & kShapeRect) != 0u ? kGridRect : 0u) | ((shape.marks & kShapeBond) != 0u ? kGridBond : 0u);
    g.thickness = shape.thickness;
    g.colour = shape.colour;
    g.base = shape.base;
    g.shrink = rcpExact(shape.stretch);
    g.region = shape.region;
    g.atom = shape.atom;
    g.house = shape.house | (env.generations.v[shape.house] << 24u);
    g.firstRow = firstRow;
    env.grids.v[at] = g;
    u64 hash = mix64(shape.key + mix64((u64(shape.cells) << 32) | u64(g.mesh)));
    hash = mix64(hash + ((u64(quantised(g.origin.x)) << 32) | u64(quantised(g.origin.z))));
    hash = mix64(hash + ((u64(quantised(g.origin.y)) << 32) | u64(quantised(g.size.x * 16.0f))));
    roofAdd(env.status.v[0].hash[0], uint(hash));
    roofAdd(env.status.v[0].hash[1], uint(hash >> 32));
}

// The shape that a rectangle or segment of another starts as: no cells, no taper.
FN RoofScope cleared(RoofScope shape) {
    shape.taper = vec2(0.0f, 0.0f);
    shape.cells = 0x10001u;
    shape.marks &= 0xFFu;
    return shape;
}
FN RoofScope sized(RoofScope shape, vec3 origin, vec3 x, vec3 y, vec2 size) {
    shape.origin = origin;
    shape.axisX = x;
    shape.axisY = y;
    shape.size = size;
    shape.step = size;
    shape.extent = size;
    return shape;
}
FN RoofScope segmentOf(RoofScope shape, vec3 from, vec3 to, vec3 y) {
    vec3 d = to - from;
    float l = length3(d);
    shape = sized(cleared(shape), from, axisOf(d), y, vec2(l, 0.0f));
    shape.marks |= kShapeSegment;
    return shape;
}

// A piece of an atom's outline as a segment that rises or, where it is level, runs with the eave; its normal lies
// between the two faces.
FN RoofScope pieceSegment(RoofScope shape, RoofRegion r, RoofPiece piece, bool forward) {
    vec3 a = regionPoint(r, piece.from, shape.base, shape.stretch);
    vec3 b = regionPoint(r, piece.to, shape.base, shape.stretch);
    vec3 from = forward ? a : b;
    vec3 to = forward ? b : a;
    vec3 normal = r.axisA * piece.normal.x + r.axisB * piece.normal.y + r.axisC * piece.normal.z;
    RoofScope s = segmentOf(shape, from, to, upward());
    s.axisY = axisOf(cross3(normal, s.axisX));
    s.region = kNoIndex;
    s.projectHeight = piece.fold;
    s.marks |= (piece.kind << kShapeJoint) | (piece.owner != 0u ? kShapeOwner : 0u);
    return s;
}

// A segment becomes an upright rectangle and a segment on top of it, a rectangle a box of four sides and a lid.
FN RoofChild extruded(RoofNumbers n, RoofScope shape, uint k) {
    float h = n.v[0];
    RoofScope plain = cleared(shape);
    vec3 x = shape.axisX;
    vec3 y = shape.axisY;
    float w = shape.size.x;
    if ((shape.marks & kShapeSegment) != 0u) {
        RoofChild c = childFor(sized(plain, shape.origin, x, upward(), vec2(w, h)), 0u);
        c.made = h > kLeastSide;
        if (k == 0u) return c;
        RoofScope top = sized(plain, shape.origin + upward() * h, x, upward(), vec2(w, 0.0f));
        top.marks |= kShapeSegment | (shape.marks & kShapeTop);
        top.base = top.origin.y;
        c = childFor(top, 1u);
        c.made = k == 1u;
        return c;
    }
    vec3 up = cross3(x, y);
    float d = shape.size.y;
    if (k == 4u) return childFor(sized(plain, shape.origin + up * h, x, y, shape.size), 1u);
    vec3 along = k == 0u ? x : k == 1u ? y : k == 2u ? -x : -y;
    vec3 from = shape.origin + x * (k == 1u || k == 2u ? w : 0.0f) + y * (k >= 2u ? d : 0.0f);
    RoofChild side = childFor(sized(plain, from, along, up, vec2((k & 1u) == 0u ? w : d, h)), 0u);
    side.number = k;
    side.made = h > kLeastSide;
    return side;
}

// Join to the roof's own targets: the rectangle around the atom's outline, in the plane of the face; then what lies on
// top of it, piece by piece.
FN RoofChild joinedRoof(RoofEnv env, RoofNumbers n, RoofScope shape, uint k) {
    RoofAtom atom = env.atoms.v[shape.atom];
    float wanted = n.v[0];
    RoofRegion r = env.regions.v[atom.region];
    shape.region = atom.region;
    shape.base = shape.origin.y;
    shape.stretch = atom.height > kLeastSide && wanted > kLeastSide ? divExact(wanted, atom.height) : 1.0f;
    if (k >= 2u) {
        RoofPiece piece = env.pieces.v[atom.firstPiece + k - 2u];
        RoofChild top = childFor(pieceSegment(shape, r, piece, false), 2u);
        top.number = k;
        top.made = piece.kind == 3u || piece.upper != kNoIndex;   // ridges, and what goes on
        if (piece.upper != kNoIndex)
            top.shape.atom = piece.upper;
        else
            top.shape.marks |= kShapeTop;
        top.shape.base = top.shape.origin.y;
        return top;
    }
    float rise = atom.slope * shape.stretch;
    float along = atom.kind == 1u ? shape.stretch : sqrtExact(1.0f + rise * rise);
    vec3 y = atom.kind == 1u ? upward() : axisOf(r.axisB + upward() * rise);
    vec3 corner = regionPoint(r, vec3(r.low.x, 0.0f, 0.0f), shape.base, shape.stretch) + y * (r.low.y * along);
    RoofScope face = sized(cleared(shape), corner, r.axisA, y, vec2(r.high.x - r.low.x, (r.high.y - r.low.y) * along));
    if (k == 1u) face.marks |= kShapeOutline;
    return childFor(face, k);
}

// Adds a region of one part with up to three planes; kNoIndex when there is no room (it is counted).
FN uint makeRegion(RoofEnv env, vec3 origin, vec3 x, vec3 y, vec2 low, vec2 high, vec4 left, vec4 right, vec4 top) {
    uint at = roofAdd(env.status.v[0].regions, 1u);
    uint part = roofAdd(env.status.v[0].parts, 1u);
    uint plane = roofAdd(env.status.v[0].planes, 3u);
    if (at >= env.regionRoom || part >= env.partRoom || plane + 3u > env.planeRoom) return kNoIndex;
    env.planes.v[plane] = left;
    env.planes.v[plane + 1u] = right;
    env.planes.v[plane + 2u] = top;
    RoofPart p;
    p.a0 = low.x;
    p.a1 = high.x;
    p.firstPlane = plane;
    p.counts = 3u | (3u << 8u);
    env.parts.v[part] = p;
    RoofRegion r;
    r.origin = origin;
    r.axisA = x;
    r.axisB = y;
    r.axisC = cross3(x, y);
    r.low = low;
    r.high = high;
    r.firstPart = part;
    r.partCount = 1u;
    env.regions.v[at] = r;
    return at;
}
// The half-plane to the left of a -> b; all of it where they coincide.
FN vec4 leftOf(vec2 a, vec2 b) {
    vec2 d = b - a;
    float l = length2(d);
    if (l < kLeastSide) return vec4(0.0f, 0.0f, 0.0f, 1.0f);
    float k = rcpExact(l);
    return vec4(d.y * k, -d.x * k, 0.0f, (d.y * a.x - d.x * a.y) * k);
}

// Join to any two points: the plane through the segment and their middle.
FN RoofChild joined(RoofEnv env, RoofNumbers n, RoofScope shape, uint k) {
    vec3 t1 = vec3(n.v[1], shape.origin.y + n.v[0], n.v[3]);
    vec3 t2 = vec3(n.v[4], shape.origin.y + n.v[0], n.v[6]);
    vec3 p = shape.origin;
    vec3 x = shape.axisX;
    float w = shape.size.x;
    vec3 middle = (t1 + t2) * 0.5f - p;
    vec3 up = middle - x * dot3(x, middle);
    bool upright = length3(up) >= kLeastSide;
    vec3 y = upright ? axisOf(up) : upward();
    if (k == 2u) {
        RoofScope top = segmentOf(shape, t1, t2, y);
        top.marks |= kShapeTop;
        top.base = t1.y;
        RoofChild c = childFor(top, 2u);
        c.made = top.size.x > kLeastSide;
        return c;
    }
    vec2 a = vec2(dot3(x, t1 - p), dot3(y, t1 - p));
    vec2 b = vec2(dot3(x, t2 - p), dot3(y, t2 - p));
    vec2 low = vec2(smaller(0.0f, smaller(a.x, b.x)), 0.0f);
    vec2 high = vec2(larger(w, larger(a.x, b.x)), larger(a.y, b.y));
    RoofScope face = sized(cleared(shape), p, x, y, vec2(w, high.y));
    face.region = kNoIndex;
    face.base = p.y;
    face.stretch = 1.0f;
    RoofChild c = childFor(face, k);
    c.made = upright;
    if (k == 1u) {
        c.shape.taper = vec2(a.x, b.x - w);
        return c;
    }
    bool square = absolute(a.x) < kLeastSide && absolute(b.x - w) < kLeastSide && absolute(a.y - b.y) < kLeastSide;
    if (square || !upright) return c;
    c.shape = sized(face, p + x * low.x, x, y, high - low);
    c.shape.region = makeRegion(env, p, x, y, low, high, leftOf(a, vec2(0.0f, 0.0f)), leftOf(vec2(w, 0.0f), b), leftOf(b, a));
    c.made = c.shape.region != kNoIndex;
    return c;
}

// Onto the plane of two axes through the rectangle's lower side.
FN RoofChild projected(RoofNumbers n, RoofScope shape) {
    vec3 normal = cross3(vectorOf(n, 0u), vectorOf(n, 3u));
    bool plane = length3(normal) > 1e-4f;
    normal = axisOf(normal);
    vec3 side = shape.axisY * shape.size.y;
    vec3 laid = side - normal * dot3(normal, side);
    laid = laid - shape.axisX * dot3(shape.axisX, laid);
    float l = length3(laid);
    RoofScope s = sized(cleared(shape), shape.origin, shape.axisX, axisOf(laid), vec2(shape.size.x, l));
    s.projectHeight = side.y - laid.y;
    RoofChild c = childFor(s, 0u);
    c.made = plane && l > kLeastSide;
    return c;
}

// The rectangle and its four sides; of a face's own outline the eave, what rises, what is level, what falls.
FN RoofChild exploded(RoofEnv env, RoofScope shape, uint k) {
    if (k == 0u) return childFor(cleared(shape), 0u);
    RoofAtom atom = env.atoms.v[shape.atom];
    if ((shape.marks & kShapeOutline) != 0u) {
        RoofRegion r = env.regions.v[atom.region];
        if (k == 1u) {
            vec3 from = regionPoint(r, vec3(0.0f, 0.0f, 0.0f), shape.base, shape.stretch);
            RoofScope eave = segmentOf(shape, from, from + r.axisA * atom.eaveLength, shape.axisY);
            eave.region = kNoIndex;
            eave.marks |= kShapeOwner;
            return childFor(eave, 1u);
        }
        RoofPiece piece = env.pieces.v[atom.firstPiece + k - 2u];
        vec3 d = r.axisA * (piece.to.x - piece.from.x) + r.axisB * (piece.to.y - piece.from.y) + r.axisC * (piece.to.z - piece.from.z);
        uint part = d.y > 1e-3f ? 2u : d.y < -1e-3f ? 4u : 3u;
        RoofChild c = childFor(pieceSegment(shape, r, piece, part == 2u), part);
        c.number = k;
        return c;
    }
    vec3 x = shape.axisX * shape.size.x;
    vec3 o = shape.origin;
    vec3 upperLeft = o + shape.axisY * shape.size.y + shape.axisX * shape.taper.x;
    vec3 upperRight = o + x + shape.axisY * shape.size.y + shape.axisX * shape.taper.y;
    vec3 from = k == 1u ? o : k == 2u ? o + x : k == 3u ? upperRight : upperLeft;
    vec3 to = k == 1u ? o + x : k == 2u ? upperRight : k == 3u ? upperLeft : o;
    vec3 inward = k == 1u ? shape.axisY : k == 2u ? -shape.axisX : k == 3u ? -shape.axisY : shape.axisX;
    return childFor(segmentOf(shape, from, to, inward), k);
}

FN RoofChild splitPart(RuleRecord rule, RoofNumbers n, RoofScope shape, uint k) {
    bool alongY = (rule.extrude & 1u) != 0u;
    float total = alongY ? shape.size.y : shape.size.x;
    float taken = 0.0f;
    float shares = 0.0f;
    for (uint i = 0u; i < kMaxSplit; ++i) {
        uint mode = (rule.extrude >> (1u + 2u * i)) & 3u;
        float v = larger(n.v[i], 0.0f);
        if (mode == kSplitRest) shares = shares + v;
        if (mode == kSplitAbsolute) taken = taken + v;
        if (mode == kSplitRelative) taken = taken + v * total;
    }
    float rest = shares > 0.0f ? divExact(larger(total - taken, 0.0f), shares) : 0.0f;
    float at = 0.0f;
    float size = 0.0f;
    for (uint i = 0u; i <= k; ++i) {
        uint mode = (rule.extrude >> (1u + 2u * i)) & 3u;
        float v = larger(n.v[i], 0.0f);
        at = at + size;
        size = mode == kSplitRest ? v * rest : mode == kSplitRelative ? v * total : v;
        size = larger(smaller(size, total - at), 0.0f);
    }
    vec3 origin = shape.origin + (alongY ? shape.axisY : shape.axisX) * at;
    vec2 sides = alongY ? vec2(shape.size.x, size) : vec2(size, shape.size.y);
    RoofScope s = sized(cleared(shape), origin, shape.axisX, shape.axisY, sides);
    s.marks |= shape.marks & (kShapeSegment | (15u << kShapeJoint) | kShapeOwner | kShapeTop);
    s.place = k;
    RoofChild c = childFor(s, k);
    c.made = size > kLeastSide && ((rule.extrude >> (1u + 2u * k)) & 3u) != 3u;
    return c;
}

// How many cells of about `wanted` fill `side`; step: from one to the next.
FN uint cellCount(float side, float wanted, bool keep, OUT(float) step) {
    wanted = larger(wanted, kLeastCell);
    float n = keep ? -floorExact(0.001f - divExact(side, wanted)) : floorExact(divExact(side, wanted) + 0.5f);
    n = limited(n, 1.0f, float(kMaxRoofCells));
    step = keep ? wanted : divExact(side, n);
    return uint(n);
}

// The cells of a Repeat: how many each way, and from one to the next.
struct RoofCells {
    uint x, y;
    vec2 step;
};
FN RoofCells cellsOf(RuleRecord rule, RoofNumbers n, RoofScope shape) {
    bool keep = (rule.extrude & kRepeatClip) != 0u;
    RoofCells c;
    c.step = shape.size;
    c.x = 1u;
    c.y = 1u;
    float s;
    if ((rule.extrude & kRepeatX) != 0u) {
        c.x = cellCount(shape.size.x, n.v[0], keep, s);
        c.step.x = s;
    }
    if ((rule.extrude & kRepeatY) != 0u) {
        c.y = cellCount(shape.size.y, n.v[1], keep, s);
        c.step.y = s;
    }
    return c;
}
FN RoofChild repeated(RuleRecord rule, RoofCells cells, RoofScope shape, uint k) {
    RoofScope cell = sized(cleared(shape), shape.origin, shape.axisX, shape.axisY, cells.step);
    cell.marks |= shape.marks & (kShapeSegment | (15u << kShapeJoint) | kShapeOwner);
    if ((rule.extrude & kRepeatGrid) != 0u) {
        cell.extent = shape.size;
        if ((shape.marks & kShapeSegment) != 0u) cell.extent.y = 1e6f;
        cell.cells = cells.x | (cells.y << 16u);
        cell.marks |= kShapeRect | ((rule.extrude & kRepeatBond) != 0u ? kShapeBond : 0u);
        return childFor(cell, 0u);
    }
    uint row = k / cells.x;
    uint column = k - row * cells.x;
    cell.origin = shape.origin + shape.axisX * (float(column) * cells.step.x) + shape.axisY * (float(row) * cells.step.y);
    cell.place = k | ((cells.x * cells.y) << 16u);
    RoofChild c = childFor(cell, 0u);
    c.number = k;
    return c;
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
    drawSites(MACHINE env.map.v[0].sites, symbol.firstSite, symbol.siteCount, shape.key, shape.key);
    runCode(MACHINE env.map.v[0].code, symbol.select);
    int chosen = symbol.ruleCount == 0u ? -1 : selectedRule(MACHINE symbol);
    if (chosen < 0) return false;
    RuleRecord rule = env.map.v[0].rules.v[symbol.firstRule + uint(chosen)];
    if (!given && rule.startInputs != 0u) giveShape(MACHINE env, shape);
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
