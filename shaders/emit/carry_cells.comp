#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/extensions.glsl"
// A cell each: what lies in it, by its numbers now and in its order, with new room to spare.
#include "shaders/emit/carry.glsl"
#include "shaders/emit/cells.h"

layout(local_size_x = 64) in;

void main() {
    uint cell = itemIndex();
    uint count = 0u;
    if (cell < kAllCells) count = push.cells.v[cell].count;
    if (count > 0u) {
        uint from = push.cells.v[cell].first;
        uint room = roomFor(count);
        uint to = atomicAdd(push.cells.v[kAllCells].count, room);
        for (uint i = 0u; i < count; ++i) {
            uint item = push.order.v[from + i];
            bool leaf = item >= push.leafBase;
            uint now = 0u;
            if (leaf) now = push.leafBaseTo + leafNow(item - push.leafBase);
            if (!leaf) now = nodeNow(item);
            push.orderTo.v[to + i] = now;
        }
        push.cells.v[cell].first = to;
        push.cells.v[cell].room = room;
    }
    if (cell < kAllCells && count == 0u) push.cells.v[cell].room = 0u;
}
