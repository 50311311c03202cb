// What roofs are grown from and what they leave (Buron 2013 §3). A roof face's eave is a 1D atom with roof targets; the
// outline above it is a region; shapes are rectangles and segments that rules replace; what remains are grids of
// terminals: a Repeat of tiles is one record, decoded by cell, a single terminal is a grid of one cell.
//
// A region has a frame of its own: a along the eave, b across it in the plan (of upright faces: up), c out of that. It is
// cut into convex parts of up to eight half-spaces, so that a terminal is clipped part by part by as many planes.
//
// What is recorded of a house counts from a plot of its own, whole metres from the world's origin: so roofs are the same to
// the bit wherever a house stands.
#ifndef ESPALIER_SHARED_ROOF_RECORDS_H
#define ESPALIER_SHARED_ROOF_RECORDS_H
#include "shaders/shared/rule_map.h"
#include "shaders/shared/waves.h"

ESPALIER_BEGIN

CONST_UINT(kRoofGroup, 64u);      // local size of the kernels
CONST_UINT(kPartPlanes, 8u);      // of one part at most: what gl_ClipDistance offers
CONST_UINT(kMaxRoofDepth, 64u);   // rules one after another, at most
CONST_UINT(kMaxRoofCells, 4096u); // of a Repeat along one axis
// Trips of one rule's loops, since software devices end a lane's loops after 65,535 in all: kRoofHandTrips for a shape and
// a successor and, in a Repeat, one a word of that one's arguments' code.
CONST_UINT(kMaxRoofTrips, 49152u);
CONST_UINT(kRoofHandTrips, 3u);

// A piece of an atom's outline above the eave, in the region's frame, from eave[1] round to eave[0]. 64 bytes.
struct RoofPiece {
    vec3 from, to;
    vec3 normal;        // of the caps that cover it: between the two faces' normals, in the frame
    uint kind;          // JointKind + 1
    uint upper;         // atom that grows on from here above a break; kNoIndex
    uint owner;         // 1: of the two faces this one draws what covers the joint
    float fold;         // tangent of the angle by which either face leans away from what lies between them
    uint spare[3];
};
STATIC_SIZE(RoofPiece, 64);

// 128 bytes. Tier 0's shape begins as the segment at the wall's foot.
struct RoofAtom {
    u64 key;
    vec3 foot;          // the wall's foot below the eave's begin, on the house's plot
    vec3 tangent;       // along the eave, unit, level
    float eaveLength;
    float wallHeight;   // from the foot to the eave
    float slope;        // tangent of the pitch
    float height;       // of the targets above the eave
    vec3 target1, target2;   // ends of the highest piece, in the region's frame; 1 on the side of the eave's begin
    uint region;        // kNoIndex: a wall without a roof of its own
    uint firstPiece, pieceCount;
    uint house;
    uint kind;          // FaceKind; 3: wall only
    uint tier;
    uint style;         // bits 7..0 RoofShape, 15..8 material, bit 16: the house has a colour, then kAtom...
    float random;       // of the house
    vec3 colour;        // of the house, linear
    vec2 corners;       // at the eave's begin and end: by how much of its overhang it goes on; below 0 at reflex corners, 0 at gables
    float overhang;     // of the house, metres; 0: as the grammar says
};
STATIC_SIZE(RoofAtom, 128);
// RoofAtom::style: 2 bits of the house, 0: chimneys as the grammar says, 1: none, 2: on every ridge; then what is among the outline's pieces.
CONST_UINT(kAtomGoesOn, 1u << 17u);    // one with an atom above it
CONST_UINT(kAtomRidged, 1u << 18u);    // a ridge
CONST_UINT(kAtomChimneys, 19u);        // first bit
CONST_UINT(kAtomOpen, 1u << 21u);      // of the house: a roof on posts
CONST_UINT(kAtomShared, 23u);          // first of 9 bits: quarters of a metre of the wall that a neighbour covers, or
CONST_UINT(kAtomClosed, 511u);         // a neighbour stands higher than the eave, and ends the roof

// 80 bytes. A region of a face first, then those that Join makes.
struct RoofRegion {
    vec3 origin;        // on the house's plot
    vec3 axisA, axisB, axisC;
    vec2 low, high;     // bounds in a and b
    uint firstPart, partCount;
    uint spare[2];
};
STATIC_SIZE(RoofRegion, 80);

// Convex; between a0 and a1. Its planes (a, b, c, d) hold where a x + b y + c z <= d. The last of them are upright cuts
// between this part and its neighbours, which only a terminal meets that is clipped anyway.
struct RoofPart {
    float a0, a1;
    uint firstPlane;
    uint counts;        // bits 7..0 planes, 15..8 of them the outline's own
};
STATIC_SIZE(RoofPart, 16);

// RoofScope::marks: bits 7..0 rules so far, then
CONST_UINT(kShapeSegment, 1u << 8u);
CONST_UINT(kShapeOutline, 1u << 9u);   // the face itself: Explode gives the pieces of its outline
CONST_UINT(kShapeTop, 1u << 10u);      // lies on top of its atom's face, which is used up
CONST_UINT(kShapeRect, 1u << 11u);     // cells: clipped by `extent`
CONST_UINT(kShapeBond, 1u << 12u);
CONST_UINT(kShapeOwner, 1u << 13u);
CONST_UINT(kShapeJoint, 16u);          // bits 19..16: JointKind + 1

// 144 bytes. A rectangle: origin, sides along the unit axes of `size`; its upper corners may be moved along x by `taper`.
struct RoofScope {
    u64 key;
    vec3 origin, axisX, axisY;
    vec2 size;          // of one cell, if it has many
    vec2 taper;
    vec2 step, extent;  // from cell to cell; of all cells together
    uint cells;         // bits 15..0 along x, 31..16 along y
    float thickness;    // factor of terminals' z
    uint colour;        // bits 23..0 square roots of red, green, blue; 31..24 tint
    float projectHeight;   // of segments of an outline: RoofPiece::fold
    float base;         // height of the eave that its region is measured from
    float stretch;      // factor by which the roof is higher than the structure says
    uint region;
    uint atom;
    uint symbol;
    uint place;         // bits 15..0 index, 31..16 count in its Repeat
    uint marks;
    uint layers;        // bits 7..0 layer + 1 that takes cells away, 15..8 layer + 1 that moss grows by
    float args[4];
};
STATIC_SIZE(RoofScope, 144);
RECORD_ACCESS(RoofScope)
RECORD_WORDS(RoofScope)
RECORD_OFFSETS(RoofScope)

// RoofGrid::mesh: bits 7..0 mesh
CONST_UINT(kGridRect, 1u << 8u);
CONST_UINT(kGridBond, 1u << 9u);       // odd rows begin half a step earlier and have one cell more
CONST_UINT(kGridDrop, 16u);            // bits 19..16: the grammar's layer + 1 that takes cells away
CONST_UINT(kGridMoss, 20u);            // bits 23..20: likewise, that moss grows by

// 128 bytes: what is drawn.
struct RoofGrid {
    u64 key;
    vec3 origin, axisX, axisY;   // on the house's plot
    vec2 size, step, extent, taper;
    uint cells;
    uint mesh;
    float thickness;
    uint colour;
    float base;
    float shrink;       // 1 / RoofScope::stretch
    uint region;
    uint atom;
    uint house;         // bits 31..24 the house's generation, 23..0 its number
    uint firstRow;      // of its runs; kNoIndex: all cells are whole
    uint spare[3];
};
STATIC_SIZE(RoofGrid, 128);
RECORD_ACCESS(RoofGrid)

// Cells of one row of a grid: those that its region touches, and among them a run of whole ones. 8 bytes.
struct RoofRun {
    uint touched;       // bits 15..0 first, 31..16 count
    uint whole;
};
STATIC_SIZE(RoofRun, 8);
RECORD_ACCESS(RoofRun)

// A house's: where what is recorded of it counts from, and which of its grids are drawn.
struct RoofPlot {
    vec2 at;            // world x and z, whole metres
    uint generation;    // grids of another are gone
    uint spare;
};
STATIC_SIZE(RoofPlot, 16);

// A terminal mesh's bounds, in units of its cell's size (z: metres).
struct RoofMesh {
    vec3 low, high;
};
STATIC_SIZE(RoofMesh, 24);

struct RoofStatus {
    uint grids, rows;   // asked for; beyond the room nothing is written
    uint regions, parts, planes;
    uint stopped;       // shapes that a limit ended
    uint deep;          // of them those whose rules would lead on beyond the limit on depth
    uint touched, whole;   // cells
    uint terminals;     // grids of one cell
    uint hash[2];       // of all grids, in no order
    uint firstGrid;     // those before it stand
    uint gridGroups[3]; // VkDispatchIndirectCommand over the others
};
STATIC_SIZE(RoofStatus, 64);

// What rules of a grammar do, as bits 1 << kRule... of their kinds and these. The kernel is specialised to what grammars
// use, since a software device runs code for what none uses all the same.
CONST_UINT(kRuleJoinRoof, 11u);    // kRuleJoin to the roof's own targets: here a kind of its own
CONST_UINT(kRoofUsesLayers, 1u << 16u);
CONST_UINT(kRoofUsesAll, 0x1FFFFu);
FN uint roofKind(RuleRecord rule) { return rule.kind == kRuleJoin && rule.extrude != 0u ? kRuleJoinRoof : rule.kind; }

// Painted layers lie over a square of the plan: rows of `size` texels, the first row the northernmost (least z), from the
// west (least x). A grammar of roofs reads up to eight.
CONST_UINT(kRoofLayers, 8u);
struct RoofSite {
    vec2 low;           // world x and z of the square's corner
    float perMetre;     // texels
    uint size;
};
STATIC_SIZE(RoofSite, 16);
struct RoofLayer {
    FloatBuf texels;    // not given: nothing is painted
    float fill;
    uint spare;
};
STATIC_SIZE(RoofLayer, 16);
BUFFER(RoofLayerBuf, RoofLayer)

BUFFER(RoofPieceBuf, RoofPiece)
BUFFER(RoofAtomBuf, RoofAtom)
BUFFER(RoofRegionBuf, RoofRegion)
BUFFER(RoofPartBuf, RoofPart)
BUFFER(RoofScopeBuf, RoofScope)
BUFFER(RoofGridBuf, RoofGrid)
BUFFER(RoofRunBuf, RoofRun)
BUFFER(RoofMeshBuf, RoofMesh)
BUFFER(RoofPlotBuf, RoofPlot)
BUFFER(RoofStatusBuf, RoofStatus)
BUFFER(Vec4Buf, vec4)

#ifdef __cplusplus
inline uint roofAdd(uint& memory, uint value) { return __atomic_fetch_add(&memory, value, __ATOMIC_RELAXED); }
inline uint roofOr(uint& memory, uint value) { return __atomic_fetch_or(&memory, value, __ATOMIC_RELAXED); }
#else
#define roofAdd atomicAdd
#define roofOr atomicOr
#endif

// What the kernels read and write; all of it by address.
struct RoofEnv {
    RuleMapBuf map;           // one
    RoofAtomBuf atoms;
    RoofPieceBuf pieces;
    RoofRegionBuf regions;    // room for those that Join makes
    RoofPartBuf parts;
    Vec4Buf planes;
    RoofScopeBuf queues[2];   // of a wave, and of the next one, by turns
    RoofGridBuf grids;
    RoofRunBuf runs;
    RoofMeshBuf meshes;
    RoofStatusBuf status;
    WaveBuf waves;
    RoofPlotBuf plots;        // [house]
    uint wave;
    uint shapeRoom, gridRoom, rowRoom, regionRoom, partRoom, planeRoom;
    uint startSymbol;         // of the first wave's shapes
    UintBuf starts;           // the atoms that they stand on
    RoofLayerBuf layers;      // [kRoofLayers], as the grammar counts them
    FloatBuf means;           // [house * kRoofLayers + layer]: the mean over the house
    UintBuf reads;            // [house]: what it has asked of layers: bits 7..0 at places, 15..8 means
    RoofSite site;
    u64 words;                // address of the map's words
};
STATIC_SIZE(RoofEnv, 200);

ESPALIER_END
#endif
