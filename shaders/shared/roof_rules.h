// The shapes that each kind of rule makes of a shape (Buron 2013 §3.2 to §3.4, §4).
#ifndef ESPALIER_SHARED_ROOF_RULES_H
#define ESPALIER_SHARED_ROOF_RULES_H
#include "shaders/shared/roof_shape.h"

ESPALIER_BEGIN

// One of the shapes that a rule makes. part: whose successors take it; number tells apart shapes of one part.
struct RoofChild {
    RoofScope shape;
    uint part, number;
    bool made;
};
FN RoofChild childFor(RoofScope shape, uint part) {
    RoofChild c = {};
    c.shape = shape;
    c.part = part;
    c.number = 0u;
    c.made = true;
    return c;
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
FN RoofChild joinedRoof(RoofEnv env, RoofNumbers n, RoofScope shape, RoofAtom atom, RoofRegion r, uint k) {
    float wanted = n.v[0];
    shape.region = atom.region;
    shape.base = shape.origin.y;
    shape.stretch = atom.height > kLeastSide && wanted > kLeastSide ? divExact(wanted, atom.height) : 1.0f;
    if (k >= 2u) {
        RoofPiece piece = readPiece(env, atom.firstPiece + k - 2u);
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
    RoofPart p = {};
    p.a0 = low.x;
    p.a1 = high.x;
    p.firstPlane = plane;
    p.counts = 3u | (3u << 8u);
    env.parts.v[part] = p;
    RoofRegion r = {};
    r.origin = origin;
    r.axisA = x;
    r.axisB = y;
    r.axisC = cross3(x, y);
    r.low = low;
    r.high = high;
    r.firstPart = part;
    r.partCount = 1u;
    r.spare[0] = 0u;
    r.spare[1] = 0u;
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

// Join to any two points of the world: the plane through the segment and their middle.
FN RoofChild joined(RoofEnv env, RoofNumbers n, RoofScope shape, vec2 plot, uint k) {
    vec3 t1 = vec3(n.v[1] - plot.x, shape.origin.y + n.v[0], n.v[3] - plot.y);
    vec3 t2 = vec3(n.v[4] - plot.x, shape.origin.y + n.v[0], n.v[6] - plot.y);
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
FN RoofChild exploded(RoofEnv env, RoofScope shape, RoofAtom atom, RoofRegion r, uint k) {
    if (k == 0u) return childFor(cleared(shape), 0u);
    if ((shape.marks & kShapeOutline) != 0u) {
        if (k == 1u) {
            vec3 from = regionPoint(r, vec3(0.0f, 0.0f, 0.0f), shape.base, shape.stretch);
            RoofScope eave = segmentOf(shape, from, from + r.axisA * atom.eaveLength, shape.axisY);
            eave.region = kNoIndex;
            eave.marks |= kShapeOwner;
            RoofChild c = childFor(eave, 1u);
            c.number = k;
            return c;
        }
        RoofPiece piece = readPiece(env, atom.firstPiece + k - 2u);
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
    RoofChild side = childFor(segmentOf(shape, from, to, inward), k);
    side.number = k;
    return side;
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
    RoofCells c = {};
    c.step = shape.size;
    c.x = 1u;
    c.y = 1u;
    float s = 0.0f;
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

ESPALIER_END
#endif
