#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/extensions.glsl"
// What is kept of cells -> where their items begin in the list, in the order of cells, and the dispatches that go through
// it in blocks. One group: a lane takes cells that follow each other.
#include "shaders/emit/emit_push.glsl"

layout(local_size_x = 112) in;

const uint kLanes = 112u;
const uint kLaneCells = kAllCells / kLanes;
const uint kSpanLanes = kLanes * kLeafClass * kMaxCells / kAllCells;   // their cells hold spans, those of others leaves
shared uint laneItems[kLanes];

// Groups over y beyond 65,535 (shaders/shared/dispatch.glsl).
void writeGroups(uint at, uint groups) {
    push.state.v[0].groups[at] = min(groups, 65535u);
    push.state.v[0].groups[at + 1u] = (groups + 65534u) / 65535u;
    push.state.v[0].groups[at + 2u] = 1u;
}
uint blocksOf(uint items) { return (items + kBlockItems - 1u) / kBlockItems; }

void main() {
    uint lane = gl_LocalInvocationID.x;
    uint first = lane * kLaneCells;
    uint count = 0u;
    for (uint c = first; c < first + kLaneCells; ++c) count += push.seen.v[c];
    laneItems[lane] = count;
    barrier();
    uint at = 0u;
    for (uint l = lane < kSpanLanes ? 0u : kSpanLanes; l < lane; ++l) at += laneItems[l];
    uint spans = 0u;
    for (uint l = 0u; l < kSpanLanes; ++l) spans += laneItems[l];
    if (lane == kLanes - 1u) {
        uint leaves = at + count;
        push.state.v[0].listed[0] = spans;
        push.state.v[0].listed[1] = leaves;
        push.state.v[0].blocks[0] = blocksOf(spans);
        push.state.v[0].blocks[1] = blocksOf(leaves);
        writeGroups(0u, blocksOf(spans));
        writeGroups(3u, blocksOf(leaves));
        writeGroups(6u, blocksOf(spans) + blocksOf(leaves));
        push.state.v[0].fullTriangles = push.cells.v[kAllCells].first;
        push.state.v[0].boundItems = push.cells.v[kAllCells].changed;
        push.state.v[0].crowded = push.cells.v[kAllCells].room;
        push.state.v[0].ordered = push.cells.v[kAllCells].count;
    }
    at += lane < kSpanLanes ? 0u : blocksOf(spans) * kBlockItems;
    for (uint c = first; c < first + kLaneCells; ++c) {
        push.seen.v[kAllCells + c] = at;
        at += push.seen.v[c];
    }
}
