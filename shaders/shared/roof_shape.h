// A shape of a roof grammar: what a rule may ask of it, the commands that change it, shapes that start from it.
#ifndef ESPALIER_SHARED_ROOF_SHAPE_H
#define ESPALIER_SHARED_ROOF_SHAPE_H
#include "shaders/shared/roof_lane.h"
#include "shaders/shared/roof_layers.h"

ESPALIER_BEGIN

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
    SET_SLOT(slot, v.x);
    SET_SLOT(slot + 1u, v.y);
    SET_SLOT(slot + 2u, v.z);
}

// Fills the slots of rule_map.h for the lane's shape.
FN void giveLayers(LANE_PARAM uint layers) {
    if (layers == 0u) return;
    RoofScope shape = laneShape(MACHINE_ONLY);
    uint house = ENV.atoms.v[shape.atom].house;
    vec3 p = shape.origin + shape.axisX * (0.5f * shape.size.x) + shape.axisY * (0.5f * shape.size.y);
    vec2 at = vec2(p.x, p.z) + plotOf(ENV, house);
    uint i = 0u;
    do {
        if ((layers >> i & 1u) != 0u) SET_SLOT(kSlotLayer + i, roofLayerAt(ENV.layers, ENV.site, i, at));
        if ((layers >> (i + kRoofLayers) & 1u) != 0u) SET_SLOT(kSlotLayer + kRoofLayers + i, ENV.means.v[house * kRoofLayers + i]);
        i += 1u;
    } while (((layers | layers >> kRoofLayers) & 255u) >> i != 0u);
    roofOr(ENV.reads.v[house], layers);
}
FN void giveOutline(LANE_ONLY_PARAM) {
    RoofScope shape = laneShape(MACHINE_ONLY);
    vec2 plot = plotOf(ENV, ENV.atoms.v[shape.atom].house);
    vec3 there = vec3(plot.x, 0.0f, plot.y);
    giveVector(MACHINE kSlotPos0, shape.origin + there);
    giveVector(MACHINE kSlotPos1, shape.origin + shape.axisX * shape.size.x + there);
    giveVector(MACHINE kSlotLocalNormal, cross3(shape.axisX, shape.axisY));
    giveVector(MACHINE kSlotLocalTangent, shape.axisX);
    SET_SLOT(kSlotProjectHeight, shape.projectHeight);
    SET_SLOT(kSlotSizeX, shape.size.x);
    SET_SLOT(kSlotSizeY, shape.size.y);
    SET_SLOT(kSlotIndex, float(shape.place & 0xFFFFu));
    SET_SLOT(kSlotCount, float(shape.place >> 16u));
    SET_SLOT(kSlotJoint, float((shape.marks >> kShapeJoint) & 15u));
    SET_SLOT(kSlotOwner, (shape.marks & kShapeOwner) != 0u ? 1.0f : 0.0f);
}
FN void giveTargets(LANE_PARAM uint inputs) {
    RoofScope shape = laneShape(MACHINE_ONLY);
    RoofAtom atom = ENV.atoms.v[shape.atom];
    vec2 plot = plotOf(ENV, atom.house);
    vec3 target1 = atom.foot;
    vec3 target2 = atom.foot;
    float start = 0.0f;
    if ((inputs & kInputsOfTargets) != 0u && atom.region != kNoIndex) {
        RoofRegion face = ENV.regions.v[atom.region];
        target1 = regionPoint(face, atom.target1, shape.base, shape.stretch);
        target2 = regionPoint(face, atom.target2, shape.base, shape.stretch);
        start = -face.low.x;
    }
    giveVector(MACHINE kSlotRoofPos1, target1 + vec3(plot.x, 0.0f, plot.y));
    giveVector(MACHINE kSlotRoofPos2, target2 + vec3(plot.x, 0.0f, plot.y));
    SET_SLOT(kSlotEaveStart, start);
}
FN void giveHouse(LANE_ONLY_PARAM) {
    RoofAtom atom = ENV.atoms.v[laneShape(MACHINE_ONLY).atom];
    giveVector(MACHINE kSlotEaveTangent, atom.tangent);
    SET_SLOT(kSlotRoofHeight, atom.height);
    SET_SLOT(kSlotRoofSlope, atom.slope);
    SET_SLOT(kSlotEaveLength, atom.eaveLength);
    SET_SLOT(kSlotFaceKind, float(atom.kind));
    SET_SLOT(kSlotTier, float(atom.tier));
    SET_SLOT(kSlotWallHeight, atom.wallHeight);
    SET_SLOT(kSlotHouseRandom, atom.random);
    SET_SLOT(kSlotHouseShape, float(atom.style & 255u));
    SET_SLOT(kSlotHouseMaterial, float((atom.style >> 8u) & 255u));
    SET_SLOT(kSlotHouseTinted, float((atom.style >> 16u) & 1u));
    giveVector(MACHINE kSlotHouseColour, atom.colour);
    SET_SLOT(kSlotCorners, atom.corners.x);
    SET_SLOT(kSlotCorners + 1u, atom.corners.y);
    SET_SLOT(kSlotHouseOverhang, atom.overhang);
    SET_SLOT(kSlotHouseChimneys, float((atom.style >> kAtomChimneys) & 3u));
    SET_SLOT(kSlotHouseOpen, (atom.style & kAtomOpen) != 0u ? 1.0f : 0.0f);
    uint covered = atom.style >> kAtomShared;
    SET_SLOT(kSlotWallShared, covered == kAtomClosed ? atom.wallHeight : 0.25f * float(covered));
}
// inputs: as the compiler notes them for these slots, by their places among a plant's.
FN void giveShape(LANE_PARAM uint inputs) {
    giveOutline(MACHINE_ONLY);
    giveTargets(MACHINE inputs);
    giveHouse(MACHINE_ONLY);
}

FN uint packColour(float r, float g, float b) {
    return uint(sqrtExact(limited(r, 0.0f, 1.0f)) * 255.0f + 0.5f) |
           (uint(sqrtExact(limited(g, 0.0f, 1.0f)) * 255.0f + 0.5f) << 8u) |
           (uint(sqrtExact(limited(b, 0.0f, 1.0f)) * 255.0f + 0.5f) << 16u);
}

// The lane's shape after S, T, R, Tint, Colour, Drop and Moss of a rule. What is negative leaves what there is.
FN RoofScope changedShape(LANE_ONLY_PARAM) {
    RoofScope shape = laneShape(MACHINE_ONLY);
    vec3 size = vectorOf(MACHINE 0u);
    vec3 move = vectorOf(MACHINE 3u);
    float turn = NUMBER(6u);
    float pitch = NUMBER(7u);
    float tint = NUMBER(8u);
    vec3 colour = vectorOf(MACHINE 9u);
    vec3 normal = cross3(shape.axisX, shape.axisY);
    shape.origin = shape.origin + shape.axisX * move.x + shape.axisY * move.y + normal * move.z;
    if (size.x >= 0.0f) shape.size.x = size.x;
    if (size.y >= 0.0f) shape.size.y = size.y;
    if (size.z >= 0.0f) shape.thickness = size.z;
    float s = 0.0f;
    float c = 0.0f;
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
    if (NUMBER(12u) >= 0.0f) shape.layers = (shape.layers & 0xFF00u) | uint(limited(NUMBER(12u), 0.0f, 8.0f));
    if (NUMBER(13u) >= 0.0f) shape.layers = (shape.layers & 0xFFu) | (uint(limited(NUMBER(13u), 0.0f, 8.0f)) << 8u);
    return shape;
}

// What expansion begins with: a segment at the wall's foot.
FN RoofScope startShape(RoofAtom atom, uint number, uint symbol) {
    RoofScope s = {};
    s.key = atom.key;
    s.origin = atom.foot;
    s.axisX = atom.tangent;
    s.axisY = upward();
    s.size = vec2(atom.eaveLength, 0.0f);
    s.taper = vec2(0.0f, 0.0f);
    s.step = s.size;
    s.extent = s.size;
    s.cells = 0x10001u;
    s.thickness = 1.0f;
    s.colour = 0x80FFFFFFu;
    s.projectHeight = 0.0f;
    s.base = atom.foot.y + atom.wallHeight;
    s.stretch = 1.0f;
    s.region = kNoIndex;
    s.atom = number;
    s.symbol = symbol;
    s.place = 0u;
    s.marks = kShapeSegment;
    s.layers = 0u;
    for (uint a = 0u; a < 4u; ++a) s.args[a] = 0.0f;
    return s;
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

ESPALIER_END
#endif
