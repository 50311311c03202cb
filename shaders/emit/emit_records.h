// What culling reads and leaves: the view, the table of terminal meshes, instances sorted by bucket, draws.
//
// A terminal kind (TerminalRecord::mesh: bark, leaf, pebble) has variants (leaf shapes), a variant has LODs. Each
// (variant, LOD) is a bucket: one mesh, drawn by two indirect commands. Buckets of bark come first.
#ifndef ESPALIER_EMIT_RECORDS_H
#define ESPALIER_EMIT_RECORDS_H
#include "shaders/shared/growth_records.h"

ESPALIER_BEGIN

#ifdef __cplusplus
using glm::mat4;
#endif

CONST_UINT(kMaxTerminalKinds, 48u);
CONST_UINT(kMaxVariants, 48u);
CONST_UINT(kMaxLods, 6u);
CONST_UINT(kMaxBuckets, 64u);
CONST_UINT(kNoBucket, 0xFFu);
CONST_UINT(kLastPlace, 0xFFFFFFu);
CONST_UINT(kFullDetail, 1u);   // EmitView::flags: every instance at LOD 0, nothing is culled, thickened or thinned out
CONST_UINT(kShowDepth, 2u);    // instances are told how many branches lead to them

// An item's class: bits 31..24 bucket (kNoBucket: not seen), 23..0 place in it. Places from kLastPlace on are one: no
// buffer of instances has room for so many, so that all of them are overflow and none is written.
FN uint classWord(uint bucket, uint place) { return (bucket << 24u) | (place < kLastPlace ? place : kLastPlace); }
FN uint classBucket(uint word) { return word >> 24u; }
FN uint classPlace(uint word) { return word & kLastPlace; }

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
    // lies behind it is culled.
    mat4 viewProjection;
    FloatBuf tiles;
    uint width, height;   // of the picture, pixels
};
STATIC_SIZE(EmitView, 208);
CONST_UINT(kDepthTile, 8u);

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

// Counters of one cull. starts: of bark buckets in the spans, of the others in the leaves.
struct EmitState {
    uint counts[64];
    uint starts[64];
    DrawCommand draws[128];     // two a bucket
    uint spanCount, leafCount;  // visible instances written
    uint overflow;              // instances for which there was no room
    uint drawnTriangles;
    uint fullTriangles;         // of all bark and leaves at full detail, seen or not
    uint kept[2];               // spans and leaves that culling has left, in EmitPush::kept
    uint writeGroups[6];        // VkDispatchIndirectCommand of writing either
};
STATIC_SIZE(EmitState, 3124);

// An item that culling has left: its number and its classWord.
struct KeptItem {
    uint item, word;
};
STATIC_SIZE(KeptItem, 8);
BUFFER(KeptItemBuf, KeptItem)

// A visible span in the world, 96 bytes: vertex shaders read it as six texels.
//   bits 2..0 LOD, 7..3 depth (branches from the seed, kShowDepth only), bit 8 rounded tip, bits 31..16 fade (unorm16: how much of a pixel it covers)
struct SpanInstance {
    vec3 p0, b1, b2, p3;
    uint normal0, normal1;      // octahedral, surface
    float radius0, radius1;
    float arc0, metres;         // along the branch where it starts; of the span
    float rise;                 // the bark's axis lies this many radii above the curve
    uint bits;
    uint spare[4];
};
STATIC_SIZE(SpanInstance, 96);

// A visible loose terminal in the world, 64 bytes: four texels. axes: columns times size: mesh x, y, z.
//   bits 2..0 LOD, 7..3 depth as above, 15..8 kind, 31..16 depth below the canopy's outside (unorm16: 1 at the surface)
struct LeafInstance {
    vec3 origin;
    vec3 axisX, axisY, axisZ;
    uint normal;                // octahedral, of the surface below
    uint tint;                  // Leaf::tint
    uint hash;
    uint bits;
};
STATIC_SIZE(LeafInstance, 64);

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
BUFFER(TriangleVertexBuf, TriangleVertex)

// Push data of the culling kernels. View and table come as uniform blocks: software devices read these once for all lanes.
struct EmitPush {
    EmitStateBuf state;
    KeptItemBuf kept;           // spans, and from nodeCount on leaves
    NodeBuf nodes;
    ChunkBuf chunks;
    LeafBuf leaves;
    SurfaceBuf surfaces;
    SpanInstanceBuf spanInstances;
    LeafInstanceBuf leafInstances;
    uint nodeCount, leafCount;
    uint spanCapacity, leafCapacity;
};
STATIC_SIZE(EmitPush, 80);

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
    SpanInstanceBuf spans;
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
