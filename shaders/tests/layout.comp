#version 460
// Names every record that host and shaders share, so that a test can compare their layouts member by member.
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/extensions.glsl"
#include "shaders/emit/emit_records.h"
#include "shaders/shared/growth_records.h"
#include "shaders/shared/rule_map.h"

layout(local_size_x = 1) in;

struct EmitRecords {
    EmitView view;
    KindRecord kind;
    VariantRecord variant;
    BucketRecord bucket;
    EmitTable table;
    DrawCommand draw;
    EmitCell cell;
    DrawnItem drawn;
    EmitState state;
    SpanInstance span;
    LeafInstance leaf;
    TerminalVertex vertex;
    TriangleVertex triangle;
    BindInputs bind;
    CarryPush carry;
    TakePush take;
    EmitPush push;
    TrianglesPush triangles;
};
BUFFER(EmitRecordsBuf, EmitRecords)

layout(push_constant, scalar) uniform Push {
    UintBuf result;
    SurfaceBuf surfaces;
    LayerBuf layers;
    SeedBuf seeds;
    WorkItemBuf items;
    NodeBuf nodes;
    ChunkBuf chunks;
    BranchBuf branches;
    LeafBuf leaves;
    RuleMapBuf ruleMaps;
    EmitRecordsBuf emits;
};

void main() {
    // A module holds the types of what it touches.
    result.v[0] = uint(uint64_t(surfaces) ^ uint64_t(layers) ^ uint64_t(seeds) ^ uint64_t(items) ^ uint64_t(nodes) ^
                       uint64_t(chunks) ^ uint64_t(branches) ^ uint64_t(leaves) ^ uint64_t(ruleMaps) ^
                       uint64_t(emits));
}
