#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/extensions.glsl"
// What is kept of cells -> blocks, in the order of cells, and the dispatches that go through them. One group: a lane
// takes cells that follow each other.
#include "shaders/emit/emit_push.glsl"

layout(local_size_x = 80) in;

const uint kLanes = 80u;
const uint kLaneCells = kAllCells / kLanes;
const uint kSpanLanes = kLanes * kLeafClass * kMaxCells / kAllCells;   // their cells hold spans, those of others leaves
shared uint laneBlocks[kLanes];

uint blocksOf(uint cell) { return (push.seen.v[cell] + kBlockItems - 1u) / kBlockItems; }

// Groups over y beyond 65,535 (shaders/shared/dispatch.glsl).
void writeGroups(uint at, uint groups) {
    push.state.v[0].groups[at] = min(groups, 65535u);
    push.state.v[0].groups[at + 1u] = (groups + 65534u) / 65535u;
    push.state.v[0].groups[at + 2u] = 1u;
}

void main() {
    uint lane = gl_LocalInvocationID.x;
    uint first = lane * kLaneCells;
    uint count = 0u;
    for (uint c = first; c < first + kLaneCells; ++c) count += blocksOf(c);
    laneBlocks[lane] = count;
    barrier();
    uint at = 0u;
    for (uint l = 0u; l < lane; ++l) at += laneBlocks[l];
    if (lane == kSpanLanes) {
        push.state.v[0].blocks[0] = at;
        writeGroups(0u, at);
    }
    if (lane == kLanes - 1u) {
        uint spans = 0u;
        for (uint l = 0u; l < kSpanLanes; ++l) spans += laneBlocks[l];
        push.state.v[0].blocks[1] = at + count - spans;
        writeGroups(3u, at + count - spans);
        writeGroups(6u, at + count);
        push.state.v[0].fullTriangles = push.cells.v[kAllCells].first;
        push.state.v[0].boundItems = push.cells.v[kAllCells].changed;
        push.state.v[0].crowded = push.cells.v[kAllCells].room;
    }
    for (uint c = first; c < first + kLaneCells; ++c) {
        uint kept = push.seen.v[c];
        uint item = kept > 0u ? push.cells.v[c].first : 0u;
        for (uint done = 0u; done < kept; done += kBlockItems)
            push.blocks.v[at++] = EmitBlock(item + done, min(kept - done, kBlockItems), c / (kLeafClass * kMaxCells), 0u);
    }
}
