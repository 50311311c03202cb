// What binding and culling read and leave: instances of all that has grown, in cells of space; the view, the table of
// terminal meshes, what is drawn sorted by bucket, draws.
//
// A terminal kind (TerminalRecord::mesh: bark, leaf, pebble) has variants (leaf shapes), a variant has LODs. Each
// (variant, LOD) is a bucket: one mesh, drawn by two indirect commands. Buckets of bark come first.
#ifndef ESPALIER_EMIT_RECORDS_H
#define ESPALIER_EMIT_RECORDS_H
#include "shaders/shared/constants.h"
#include "shaders/shared/growth_records.h"
#include "shaders/shared/terminal_meshes.h"

ESPALIER_BEGIN

#ifdef __cplusplus
using glm::mat4;
#endif

CONST_UINT(kMaxTerminalKinds, 48u);
CONST_UINT(kMaxVariants, 48u);
CONST_UINT(kMaxLods, 6u);
CONST_UINT(kMaxBuckets, 64u);
CONST_UINT(kNoBucket, 0xFFu);
// Leaves and blossoms hang and turn to the light; other kinds lie as they were put.
FN bool hangs(uint kind) { return shippedMesh(kind) != kMeshPebble && shippedMesh(kind) < kMeshTuft; }
// The pictures of leaves hold upper sides in their upper half, and the backs of these half the picture lower.
FN bool showsBack(uint kind) { return shippedMesh(kind) != kMeshPebble && shippedMesh(kind) != kMeshTuft; }

CONST_UINT(kStretches, 2u);    // EmitView::flags: spans that follow each other may be drawn as one
CONST_UINT(kFullDetail, 1u);   // EmitView::flags: every instance at LOD 0, nothing is culled, thickened or thinned out
CONST_UINT(kTilesStand, 4u);   // EmitView::flags: what tiles say stands already when the view is recorded

// What a cull is for. A sphere (c, r) is outside if dot(planes[i].xyz, c) + planes[i].w < -r for some i.
struct EmitView {
    vec4 planes[6];
    vec3 eye;             // world; parallel projection: unused
    float pixelScale;     // pixels that one metre covers at one metre's distance; parallel: at any distance
    float lodPixels;      // error allowed, in pixels
    uint parallel;
    uint flags;
    float leastPixels;    // radius in pixels below which bark is thickened and faded instead
    // Farthest depth (reversed: the least) that the models leave in each tile of the picture; address 0: none. What
    // lies behind it is culled. Of a picture that is watched (Emit::watch): kKeptTile or kChangedTile.
    mat4 viewProjection;
    FloatBuf tiles;
    uint width, height;   // of the picture, pixels
    float wholePixels;    // leaves of at least this many pixels are all drawn, of smaller ones fewer and larger,
    float leastShare;     // but at least this share of them
    uint tilePixels;      // side of the tiles, pixels
    float drift;          // metres from this eye to that of the picture that tiles are of; 0: they are this picture's
    u64 scene;            // differs when what `tiles` says may differ; no kernel reads it
};
STATIC_SIZE(EmitView, 232);
CONST_UINT(kDepthTile, 8u);
CONST_UINT(kRibbonVertices, 4u);   // of bark drawn as a ribbon; no tube has so few
// Bits of a tile that all depths lie behind, and of one that none does.
CONST_UINT(kKeptTile, 0x7F000000u);
CONST_UINT(kChangedTile, 0xFF000000u);

struct KindRecord {
    uint firstVariant, variantCount;
    uint bark;
    uint spare;
};
STATIC_SIZE(KindRecord, 16);

// error[i]: mean distance (root mean square) of LOD i from the full mesh, in units of the instance's size (bark: of its radius).
// segments[i]: pieces of LOD i along the span, bark only.
struct VariantRecord {
    uint firstBucket, lodCount;
    float extent;         // radius of the mesh around its origin, in the same unit
    float error[6];
    float segments[6];
};
STATIC_SIZE(VariantRecord, 60);

// batch: instances that one draw command's instance covers; firstIndex: of their repeated index pattern.
struct BucketRecord {
    uint firstVertex, vertexCount;
    uint indexCount;      // of one instance
    uint batch;
    uint firstIndex;
    uint material;
};
STATIC_SIZE(BucketRecord, 24);

struct EmitTable {
    KindRecord kinds[48];
    VariantRecord variants[48];
    BucketRecord buckets[64];
    uint kindCount, variantCount, bucketCount, barkBuckets;
};
STATIC_SIZE(EmitTable, 5200);

// VkDrawIndexedIndirectCommand.
struct DrawCommand {
    uint indexCount, instanceCount, firstIndex;
    int vertexOffset;
    uint firstInstance;
};
STATIC_SIZE(DrawCommand, 20);

// Space is divided into cells of a grid; each holds its leaves and, in classes by thickness, its spans. Of each thickness
// those have a class of their own, the odd one, that far views don't draw, since the last of their stretch stands for
// them: these lie in bins by how far off it is, the worst first. All others lie in bins by their order of going when they
// are thinned out. So what a view looks at is a run of them. Cells of a class have the number class * kMaxCells + cell.
CONST_UINT(kMaxCells, 4096u);
CONST_UINT(kLeafClass, 6u);    // classes below: of spans
CONST_UINT(kAllCells, 28672u);
CONST_UINT(kCellBins, 64u);
CONST_UINT(kReachTiles, 9u);   // what reaches more tiles along a side, less one, isn't asked whether it is hidden
CONST_UINT(kScanShares, 16u);  // of a bucket's blocks, each a lane's, in scan_wide.comp
CONST_UINT(kLongRun, 64u);     // items of a bin from which on that takes a heap
CONST_UINT(kBlockItems, 64u);  // what a group of the culling kernels looks at

// A cell's spans of one class, or its leaves. reach: of any of them from the cell's middle, metres; largest: thickest
// radius, or size. Both as bits, which order as the numbers do.
struct EmitCell {
    uint first, count, room;    // in the order of items; how many may come to lie there
    uint changed;               // 1: items of it were bound anew, or left it
    uint reach, largest;
};
STATIC_SIZE(EmitCell, 24);
BUFFER(EmitCellBuf, EmitCell)

// An instance as it is drawn. bits: of a span 2..0 LOD, 5..3 how many spans before it are drawn with it, 31..16 fade (unorm16: how much of a pixel it covers); of a leaf
// 2..0 LOD. value: of a span the least radius that it is drawn with, of a leaf the factor of its size.
// bucket: kNoBucket if it isn't seen; rank: in its bucket and block. Both of notes only.
struct DrawnItem {
    uint item, bits;
    float value;
    uint place;                 // bits 31..24 bucket, 23..0 rank
};
STATIC_SIZE(DrawnItem, 16);
BUFFER(DrawnBuf, DrawnItem)

// Counters of one cull. starts: of a bucket in what is drawn, spans first.
struct EmitState {
    uint counts[64];
    uint starts[64];
    DrawCommand draws[128];     // two a bucket
    uint spanCount, leafCount;  // visible instances
    uint fullTriangles;         // of all bark and leaves at full detail, seen or not
    uint drawnTriangles;
    uint listed[2];             // items to look at: spans, leaves
    uint blocks[2];             // of these, each of kBlockItems or less; those of leaves follow those of spans
    uint groups[9];             // VkDispatchIndirectCommand for the blocks of spans, of leaves, of both
    uint boundItems;            // that the last binding looked at
    uint crowded;               // not 0: in the whole binding of this number, or since, cells had no room for what came to
                                // them, all is to be bound anew
    uint ordered;               // where room in the order of items begins
};
STATIC_SIZE(EmitState, 3152);

// Up to so many spans of a chunk that follow each other are a stretch, which far views draw as one.
CONST_UINT(kStretch, 8u);
CONST_FLOAT(kNeverJoined, 60000.0f);   // metres: an error that no view allows
// The span that ends at a node, in the world, 96 bytes: read as six texels.
//   bits 5..0 kind (63: no bark), bit 6 rounded tip, 11..7 branches from the seed, 14..12 its place in its stretch, bit 15
//   the last there, 31..16 its order of going (unorm16)
// errors: two halves, metres: how far the curve swings away from its chord; how far a ribbon for all of its stretch is off.
struct SpanInstance {
    vec3 p0, b1, b2, p3;
    uint normal0, normal1;      // octahedral, surface
    float radius0, radius1;
    float arc0, metres;         // along the branch where it starts; of the span
    uint errors;
    uint bits;
    vec3 center;                // of its stretch
    float reach;                // of the stretch's curves from there
};
STATIC_SIZE(SpanInstance, 96);
RECORD_ACCESS(SpanInstance)
RECORD_TEXELS(SpanInstance)
RECORD_OFFSETS(SpanInstance)
CONST_UINT(kNoBark, 63u);

// A loose terminal in the world, 64 bytes: four texels. axes: columns times size: mesh x, y, z.
//   bits 7..0 size as of LeafPose, 15..8 kind, 20..16 branches from the seed, 31..21 depth below the canopy's outside
//   (unorm11: 1 at the surface)
struct LeafInstance {
    vec3 origin;
    vec3 axisX, axisY, axisZ;
    uint normal;                // octahedral, of the surface below
    uint tint;                  // Leaf::tint
    uint hash;
    uint bits;
};
STATIC_SIZE(LeafInstance, 64);
RECORD_ACCESS(LeafInstance)
RECORD_TEXELS(LeafInstance)
RECORD_OFFSETS(LeafInstance)

// Vertex of a terminal mesh, 24 bytes. Bark: x and y its cross-section in radii, z in [0,1] along the span.
struct TerminalVertex {
    vec3 position;
    uint normal;                // octahedral
    vec2 uv;
};
STATIC_SIZE(TerminalVertex, 24);

// What espMaterialise hands out, 16 bytes.
struct TriangleVertex {
    vec3 position;
    uint normal;
};
STATIC_SIZE(TriangleVertex, 16);

BUFFER(EmitViewBuf, EmitView)
BUFFER(EmitTableBuf, EmitTable)
BUFFER(EmitStateBuf, EmitState)
BUFFER(SpanInstanceBuf, SpanInstance)
BUFFER(LeafInstanceBuf, LeafInstance)
BUFFER(TerminalVertexBuf, TerminalVertex)

// The grid: cell (x, y, z) of size[0] * size[1] * size[2] is the cube of 1 / rcpCell metres at low + (x, y, z) / rcpCell.
// Those at the border hold what lies beyond, too.
struct EmitGrid {
    vec3 low;
    float rcpCell;
    uint size[3];
};

CONST_UINT(kMovedWords, 128u);   // more instances than a context has places for

// What the kernels that bind growth read, a uniform block. Items are node indices, or leafBase + leaf indices.
struct BindInputs {
    NodeBuf nodes;
    ChunkBuf chunks;
    LeafBuf leaves;
    SurfaceBuf surfaces;
    SpanInstanceBuf spans;      // [node]
    LeafInstanceBuf leafInstances;
    EmitCellBuf cells;          // and one more, see below
    UintBuf bins;               // [cell * kCellBins + bin]: counts, then starts, then ends in the cell
    UintBuf keys;               // [item]: its bin, kNoIndex: none; and kFresh
    UintBuf order;              // items of cells
    UintBuf touched;            // of growth: [node] the number of the regrowth that wrote it last
    UintBuf flags;              // [node]: kFlagSpan: its span is to be bound; kFlagStretch: one of its stretch
    UintBuf list;               // items that are put into cells
    UintBuf leafHeads, leafNext;   // [node], [leaf]: chains of the leaves that are bound to each node; kNoIndex: none
    UintBuf work;               // where only a part is bound: nodes that are flagged; from leafWork on leaves on these
    EmitGrid grid;
    uint nodeCount, leafCount, leafBase;
    uint orderRoom;
    uint partly;                // 0: all is bound; 1: what there wasn't before, what regrowths have written since, and
                                // what stands on surfaces that have moved:
    uint nodesBefore, leavesBefore;
    uint written;               // 1: regrowths have, after the one of number
    uint since;
    uint leafWork;
    uint watched;               // 1: tiles of a watched picture are noted
    uint binding;               // number of the whole binding that this is, or comes after; not 0
    uint movedWords;            // that have a bit set are below this
    uint moved[kMovedWords];    // surface instances: bit i % 32 of word i / 32
};
STATIC_SIZE(BindInputs, 720);
// cells[kAllCells]: first: triangles of all items at full detail; count: where room in the order begins; changed: items
// of the list; reach, largest: nodes and leaves of the work; room: EmitState::crowded.
CONST_UINT(kFresh, 0x80000000u);
CONST_UINT(kFlagSpan, 1u);
CONST_UINT(kFlagStretch, 2u);

// Push data of the kernels that carry bound growth over to other buffers (bound_growth_carry.cpp), where each node and leaf may
// have another number.
struct CarryPush {
    UintBuf nodesWent, leavesWent;       // as GrowthMove
    EmitCellBuf cells;
    UintBuf order, orderTo;
    UintBuf keys, keysTo;
    UintBuf leafHeads, leafHeadsTo;
    UintBuf leafNext, leafNextTo;
    SpanInstanceBuf spansTo;
    LeafInstanceBuf leavesTo;
    uint nodeCount, leafCount;           // before
    uint leafBase, leafBaseTo;
};
STATIC_SIZE(CarryPush, 120);

// Push data of the culling kernels. View and table come as uniform blocks: software devices read these once for all lanes.
struct EmitPush {
    EmitStateBuf state;
    EmitCellBuf cells;
    UintBuf bins;
    UintBuf order;
    UintBuf seen;               // [cell]: items to look at; [kAllCells + cell]: where these begin in the list
    UintBuf list;               // [block * kBlockItems + lane]: items to look at
    UintBuf rows;               // [block * kMaxBuckets + bucket]: counts, then where they begin in their bucket
    DrawnBuf notes;             // [block * kBlockItems + lane]
    DrawnBuf drawn;
    EmitGrid grid;
    uint leafBase;
};
STATIC_SIZE(EmitPush, 104);

CONST_UINT(kTakenStrip, 4u);   // rows of a strip of tiles that are taken

// Push data of the kernel that takes changed tiles of a watched picture.
struct TakePush {
    FloatBuf watched;        // [tile]: kKeptTile or kChangedTile; those that are taken become kept
    FloatBuf taken;          // [tile]: kChangedTile where it is taken, else kKeptTile; [tiles]: where to begin, as bits
    uint tiles, columns;     // of the picture
    uint most;               // to be taken
    uint spare;
};
STATIC_SIZE(TakePush, 32);

// Bark at full detail as triangles: 12 sides and 10 rings, the paper's 216 polygons.
CONST_UINT(kBarkSides, 12u);
CONST_UINT(kBarkRings, 10u);
CONST_UINT(kBarkVertices, 120u);
CONST_UINT(kBarkIndices, 648u);

#ifndef __cplusplus
layout(buffer_reference, scalar, buffer_reference_align = 8) buffer U64Buf { u64 v[]; };
#else
struct U64Buf { u64* v; };
#endif

// Push data of the kernels that write triangles. Vertices and indices as 64-bit words: half as many stores.
struct TrianglesPush {
    DrawnBuf drawn;
    LeafInstanceBuf leaves;
    TerminalVertexBuf meshVertices;
    UintBuf meshIndices;
    U64Buf vertices;
    U64Buf indices;
    uint count;              // instances, from firstInstance on
    uint firstInstance;
    uint firstVertex;        // of the first instance, in `vertices`
    uint firstIndexPair;     // where its indices begin, in pairs
    uint meshFirstVertex, meshVertexCount;
    uint meshFirstIndex, meshIndexCount;
};
STATIC_SIZE(TrianglesPush, 80);

ESPALIER_END
#endif
