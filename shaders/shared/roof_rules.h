// The shapes that each kind of rule makes of a shape (Buron 2013 §3.2 to §3.4, §4).
#ifndef ESPALIER_SHARED_ROOF_RULES_H
#define ESPALIER_SHARED_ROOF_RULES_H
#include "shaders/shared/roof_shape.h"

ESPALIER_BEGIN

// One of the shapes that a rule makes, which lies in the lane's memory. part: whose successors take it; number tells apart
// shapes of one part. made: false, there is none.
struct RoofChild {
    uint part, number;
    bool made;
};
FN RoofChild childFor(LANE_PARAM RoofScope shape, uint part, uint number, bool made) {
    keepChild(MACHINE shape);
    RoofChild c = {};
    c.part = part;
    c.number = number;
    c.made = made;
    return c;
}

// A segment becomes an upright rectangle and a segment on top of it, a rectangle a box of four sides and a lid.
FN RoofChild extruded(LANE_PARAM uint k) {
    RoofScope shape = laneShape(MACHINE_ONLY);
    float h = NUMBER(0u);
    float w = shape.size.x;
    if ((shape.marks & kShapeSegment) != 0u) {
        RoofScope s = sized(cleared(shape), shape.origin, shape.axisX, upward(), vec2(w, h));
        if (k == 1u) {
            s = sized(s, shape.origin + upward() * h, shape.axisX, upward(), vec2(w, 0.0f));
            s.marks |= kShapeSegment | (shape.marks & kShapeTop);
            s.base = s.origin.y;
        }
        return childFor(MACHINE s, k, 0u, k == 1u || h > kLeastSide);
    }
    vec3 x = shape.axisX;
    vec3 y = shape.axisY;
    vec3 up = cross3(x, y);
    float d = shape.size.y;
    bool lid = k == 4u;
    vec3 along = lid || k == 0u ? x : k == 1u ? y : k == 2u ? -x : -y;
    vec3 from = lid ? shape.origin + up * h
                    : shape.origin + x * (k == 1u || k == 2u ? w : 0.0f) + y * (k >= 2u ? d : 0.0f);
    vec2 size = vec2((k & 1u) == 0u ? w : d, lid ? d : h);
    RoofScope s = sized(cleared(shape), from, along, lid ? y : up, size);
    return childFor(MACHINE s, k >> 2u, lid ? 0u : k, lid || h > kLeastSide);
}

// An atom's own; any for one without, since every town has room for one.
FN RoofRegion regionOf(LANE_PARAM RoofAtom atom) { return ENV.regions.v[atom.region != kNoIndex ? atom.region : 0u]; }

// Join to the roof's own targets: the rectangle around the atom's outline, in the plane of the face; then what lies on
// top of it, piece by piece.
FN RoofChild joinedRoof(LANE_PARAM uint k) {
    RoofScope shape = laneShape(MACHINE_ONLY);
    RoofAtom atom = ENV.atoms.v[shape.atom];
    RoofRegion r = regionOf(MACHINE atom);
    float wanted = NUMBER(0u);
    shape.region = atom.region;
    shape.base = shape.origin.y;
    shape.stretch = atom.height > kLeastSide && wanted > kLeastSide ? divExact(wanted, atom.height) : 1.0f;
    if (k >= 2u) {
        RoofPiece piece = ENV.pieces.v[atom.firstPiece + k - 2u];
        bool goesOn = piece.upper != kNoIndex;
        RoofScope top = pieceSegment(shape, r, piece, false);
        top.atom = goesOn ? piece.upper : top.atom;
        top.marks |= goesOn ? 0u : kShapeTop;
        top.base = top.origin.y;
        return childFor(MACHINE top, 2u, k, goesOn || piece.kind == 3u);   // ridges, and what goes on
    }
    float rise = atom.slope * shape.stretch;
    float along = atom.kind == 1u ? shape.stretch : sqrtExact(1.0f + rise * rise);
    vec3 y = atom.kind == 1u ? upward() : axisOf(r.axisB + upward() * rise);
    vec3 corner = regionPoint(r, vec3(r.low.x, 0.0f, 0.0f), shape.base, shape.stretch) + y * (r.low.y * along);
    RoofScope face = sized(cleared(shape), corner, r.axisA, y, vec2(r.high.x - r.low.x, (r.high.y - r.low.y) * along));
    if (k == 1u) face.marks |= kShapeOutline;
    return childFor(MACHINE face, k, 0u, true);
}

// Adds a region of one part with up to three planes; kNoIndex when there is no room (it is counted).
FN uint makeRegion(LANE_PARAM vec3 origin, vec3 x, vec3 y, vec2 low, vec2 high, vec4 left, vec4 right, vec4 top) {
    uint at = roofAdd(ENV.status.v[0].regions, 1u);
    uint part = roofAdd(ENV.status.v[0].parts, 1u);
    uint plane = roofAdd(ENV.status.v[0].planes, 3u);
    if (at >= ENV.regionRoom || part >= ENV.partRoom || plane + 3u > ENV.planeRoom) return kNoIndex;
    ENV.planes.v[plane] = left;
    ENV.planes.v[plane + 1u] = right;
    ENV.planes.v[plane + 2u] = top;
    RoofPart p = {};
    p.a0 = low.x;
    p.a1 = high.x;
    p.firstPlane = plane;
    p.counts = 3u | (3u << 8u);
    ENV.parts.v[part] = p;
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
    ENV.regions.v[at] = r;
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
FN RoofChild joined(LANE_PARAM uint k) {
    RoofScope shape = laneShape(MACHINE_ONLY);
    vec2 plot = plotOf(ENV, ENV.atoms.v[shape.atom].house);
    vec3 t1 = vec3(NUMBER(1u) - plot.x, shape.origin.y + NUMBER(0u), NUMBER(3u) - plot.y);
    vec3 t2 = vec3(NUMBER(4u) - plot.x, shape.origin.y + NUMBER(0u), NUMBER(6u) - plot.y);
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
        return childFor(MACHINE top, 2u, 0u, top.size.x > kLeastSide);
    }
    vec2 a = vec2(dot3(x, t1 - p), dot3(y, t1 - p));
    vec2 b = vec2(dot3(x, t2 - p), dot3(y, t2 - p));
    vec2 low = vec2(smaller(0.0f, smaller(a.x, b.x)), 0.0f);
    vec2 high = vec2(larger(w, larger(a.x, b.x)), larger(a.y, b.y));
    RoofScope face = sized(cleared(shape), p, x, y, vec2(w, high.y));
    face.region = kNoIndex;
    face.base = p.y;
    face.stretch = 1.0f;
    bool made = upright;
    bool square = absolute(a.x) < kLeastSide && absolute(b.x - w) < kLeastSide && absolute(a.y - b.y) < kLeastSide;
    if (k == 1u) {
        face.taper = vec2(a.x, b.x - w);
    } else if (upright && !square) {
        uint region = makeRegion(MACHINE p, x, y, low, high, leftOf(a, vec2(0.0f, 0.0f)), leftOf(vec2(w, 0.0f), b), leftOf(b, a));
        made = region != kNoIndex;
        face = sized(face, p + x * low.x, x, y, high - low);
        face.region = region;
    }
    return childFor(MACHINE face, k, 0u, made);
}

// Onto the plane of two axes through the rectangle's lower side.
FN RoofChild projected(LANE_ONLY_PARAM) {
    RoofScope shape = laneShape(MACHINE_ONLY);
    vec3 normal = cross3(vectorOf(MACHINE 0u), vectorOf(MACHINE 3u));
    bool plane = length3(normal) > 1e-4f;
    normal = axisOf(normal);
    vec3 side = shape.axisY * shape.size.y;
    vec3 laid = side - normal * dot3(normal, side);
    laid = laid - shape.axisX * dot3(shape.axisX, laid);
    float l = length3(laid);
    RoofScope s = sized(cleared(shape), shape.origin, shape.axisX, axisOf(laid), vec2(shape.size.x, l));
    s.projectHeight = side.y - laid.y;
    return childFor(MACHINE s, 0u, 0u, plane && l > kLeastSide);
}

// The rectangle and its four sides; of a face's own outline the eave, what rises, what is level, what falls.
FN RoofChild exploded(LANE_PARAM uint k) {
    RoofScope shape = laneShape(MACHINE_ONLY);
    RoofAtom atom = ENV.atoms.v[shape.atom];
    if (k == 0u) return childFor(MACHINE cleared(shape), 0u, 0u, true);
    if ((shape.marks & kShapeOutline) != 0u) {
        RoofRegion r = regionOf(MACHINE atom);
        if (k == 1u) {
            vec3 from = regionPoint(r, vec3(0.0f, 0.0f, 0.0f), shape.base, shape.stretch);
            RoofScope eave = segmentOf(shape, from, from + r.axisA * atom.eaveLength, shape.axisY);
            eave.region = kNoIndex;
            eave.marks |= kShapeOwner;
            return childFor(MACHINE eave, 1u, k, true);
        }
        RoofPiece piece = ENV.pieces.v[atom.firstPiece + k - 2u];
        vec3 d = r.axisA * (piece.to.x - piece.from.x) + r.axisB * (piece.to.y - piece.from.y) + r.axisC * (piece.to.z - piece.from.z);
        uint part = d.y > 1e-3f ? 2u : d.y < -1e-3f ? 4u : 3u;
        return childFor(MACHINE pieceSegment(shape, r, piece, part == 2u), part, k, true);
    }
    vec3 x = shape.axisX * shape.size.x;
    vec3 o = shape.origin;
    vec3 upperLeft = o + shape.axisY * shape.size.y + shape.axisX * shape.taper.x;
    vec3 upperRight = o + x + shape.axisY * shape.size.y + shape.axisX * shape.taper.y;
    vec3 from = k == 1u ? o : k == 2u ? o + x : k == 3u ? upperRight : upperLeft;
    vec3 to = k == 1u ? o + x : k == 2u ? upperRight : k == 3u ? upperLeft : o;
    vec3 inward = k == 1u ? shape.axisY : k == 2u ? -shape.axisX : k == 3u ? -shape.axisY : shape.axisX;
    return childFor(MACHINE segmentOf(shape, from, to, inward), k, k, true);
}

FN RoofChild splitPart(LANE_PARAM uint k) {
    uint detail = laneDetail(MACHINE_ONLY);
    RoofScope shape = laneShape(MACHINE_ONLY);
    bool alongY = (detail & 1u) != 0u;
    float total = alongY ? shape.size.y : shape.size.x;
    float taken = 0.0f;
    float shares = 0.0f;
    for (uint i = 0u; i < kMaxSplit; ++i) {
        uint mode = (detail >> (1u + 2u * i)) & 3u;
        float v = larger(NUMBER(i), 0.0f);
        if (mode == kSplitRest) shares = shares + v;
        if (mode == kSplitAbsolute) taken = taken + v;
        if (mode == kSplitRelative) taken = taken + v * total;
    }
    float rest = shares > 0.0f ? divExact(larger(total - taken, 0.0f), shares) : 0.0f;
    float at = 0.0f;
    float size = 0.0f;
    for (uint i = 0u; i <= k; ++i) {
        uint mode = (detail >> (1u + 2u * i)) & 3u;
        float v = larger(NUMBER(i), 0.0f);
        at = at + size;
        size = mode == kSplitRest ? v * rest : mode == kSplitRelative ? v * total : v;
        size = larger(smaller(size, total - at), 0.0f);
    }
    vec3 origin = shape.origin + (alongY ? shape.axisY : shape.axisX) * at;
    vec2 sides = alongY ? vec2(shape.size.x, size) : vec2(size, shape.size.y);
    RoofScope s = sized(cleared(shape), origin, shape.axisX, shape.axisY, sides);
    s.marks |= shape.marks & (kShapeSegment | (15u << kShapeJoint) | kShapeOwner | kShapeTop);
    s.place = k;
    return childFor(MACHINE s, k, 0u, size > kLeastSide && ((detail >> (1u + 2u * k)) & 3u) != 3u);
}

// How many cells of about `wanted` fill `side`; step: from one to the next.
FN uint cellCount(float side, float wanted, bool keep, OUT(float) step) {
    wanted = larger(wanted, kLeastCell);
    float n = keep ? -floorExact(0.001f - divExact(side, wanted)) : floorExact(divExact(side, wanted) + 0.5f);
    n = limited(n, 1.0f, float(kMaxRoofCells));
    step = keep ? wanted : divExact(side, n);
    return uint(n);
}

// How many cells a Repeat has each way, bits 15..0 along x, 31..16 along y. Its numbers become the steps from one to the
// next.
FN uint cellsOf(LANE_ONLY_PARAM) {
    uint detail = laneDetail(MACHINE_ONLY);
    bool keep = (detail & kRepeatClip) != 0u;
    vec2 step = laneShape(MACHINE_ONLY).size;
    uint x = 1u;
    uint y = 1u;
    float s = 0.0f;
    if ((detail & kRepeatX) != 0u) {
        x = cellCount(step.x, NUMBER(0u), keep, s);
        step.x = s;
    }
    if ((detail & kRepeatY) != 0u) {
        y = cellCount(step.y, NUMBER(1u), keep, s);
        step.y = s;
    }
    SET_NUMBER(0u, step.x);
    SET_NUMBER(1u, step.y);
    return x | (y << 16u);
}
FN RoofChild repeated(LANE_PARAM uint cells, uint k) {
    uint detail = laneDetail(MACHINE_ONLY);
    RoofScope shape = laneShape(MACHINE_ONLY);
    vec2 step = vec2(NUMBER(0u), NUMBER(1u));
    RoofScope cell = sized(cleared(shape), shape.origin, shape.axisX, shape.axisY, step);
    cell.marks |= shape.marks & (kShapeSegment | (15u << kShapeJoint) | kShapeOwner);
    if ((detail & kRepeatGrid) != 0u) {
        cell.extent = shape.size;
        if ((shape.marks & kShapeSegment) != 0u) cell.extent.y = 1e6f;
        cell.cells = cells;
        cell.marks |= kShapeRect | ((detail & kRepeatBond) != 0u ? kShapeBond : 0u);
        return childFor(MACHINE cell, 0u, 0u, true);
    }
    uint columns = cells & 0xFFFFu;
    uint row = k / columns;
    uint column = k - row * columns;
    cell.origin = shape.origin + shape.axisX * (float(column) * step.x) + shape.axisY * (float(row) * step.y);
    cell.place = k | ((columns * (cells >> 16u)) << 16u);
    return childFor(MACHINE cell, 0u, k, true);
}

ESPALIER_END
#endif
