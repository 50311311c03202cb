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
    for (bool there = cell < kAllCells; there; there = false) count = push.cells.v[cell].count;
    for (bool some = count > 0u; some; some = false) {
        uint from = push.cells.v[cell].first;
        uint room = roomFor(count);
        uint to = atomicAdd(push.cells.v[kAllCells].count, room);
        for (uint i = 0u; i < count; ++i) {
            uint item = push.order.v[from + i];
            bool leaf = item >= push.leafBase;
            uint now = 0u;
            for (bool is = leaf; is; is = false) now = push.leafBaseTo + leafNow(item - push.leafBase);
            for (bool is = !leaf; is; is = false) now = nodeNow(item);
            push.orderTo.v[to + i] = now;
        }
        push.cells.v[cell].first = to;
        push.cells.v[cell].room = room;
    }
    for (bool none = cell < kAllCells && count == 0u; none; none = false) push.cells.v[cell].room = 0u;
}
