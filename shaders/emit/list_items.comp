#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/extensions.glsl"
// Some lanes a cell: what is kept of it goes to the list, so that blocks are full.
#include "shaders/emit/emit_push.glsl"
#include "shaders/shared/dispatch.glsl"

layout(local_size_x = 64) in;

layout(constant_id = kConstantLanes) const uint kCellLanes = 1u;

void main() {
    uint cell = itemIndex() / kCellLanes;
    uint lane = itemIndex() % kCellLanes;
    uint kept = cell < kAllCells ? push.seen.v[cell] : 0u;
    if (kept > lane) {
        uint from = push.cells.v[cell].first;
        uint to = push.seen.v[kAllCells + cell];
        for (uint i = lane; i < kept; i += kCellLanes) push.list.v[to + i] = push.order.v[from + i];
    }
}
