#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/extensions.glsl"
// Some lanes a cell: what lies in it, by its numbers now and in its order, with new room to spare.
#include "shaders/emit/carry.glsl"
#include "shaders/emit/cells.h"

layout(local_size_x = 64) in;
layout(constant_id = kConstantLanes) const uint kCellLanes = 1u;   // 1 or 64

shared uvec2 begins[64];   // of the group's cells in the order of items: before, now

void main() {
    uint cell = itemIndex() / kCellLanes;
    uint lane = itemIndex() % kCellLanes;
    uint here = gl_LocalInvocationID.x / kCellLanes;
    uint count = 0u;
    if (cell < kAllCells) count = push.cells.v[cell].count;
    if (lane == 0u && count > 0u)
        begins[here] = uvec2(push.cells.v[cell].first, atomicAdd(push.cells.v[kAllCells].count, roomFor(count)));
    barrier();
    uint from = begins[here].x;
    uint to = begins[here].y;
    for (uint i = lane; i < count; i += kCellLanes) {
        uint item = push.order.v[from + i];
        bool leaf = item >= push.leafBase;
        uint now = 0u;
        if (leaf) now = push.leafBaseTo + leafNow(item - push.leafBase);
        if (!leaf) now = nodeNow(item);
        push.orderTo.v[to + i] = now;
    }
    if (lane == 0u && cell < kAllCells) {
        if (count > 0u) push.cells.v[cell].first = to;
        push.cells.v[cell].room = roomFor(count);
    }
}
