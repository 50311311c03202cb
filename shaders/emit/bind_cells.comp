#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/extensions.glsl"
// A cell each: room for its items in the order, with some to spare, and where its bins begin in that. Which cell comes
// first is of no account: views go through cells by their number.
#include "shaders/emit/bind.glsl"

layout(local_size_x = 64) in;

void main() {
    uint cell = itemIndex();
    if (push.partly == 0u && cell == kAllCells) HEAD.changed = push.nodeCount + push.leafCount;
    if (cell >= kAllCells || (push.partly != 0u && push.cells.v[cell].changed == 0u)) return;
    uint total = 0u;
    for (uint bin = cell * kCellBins; bin < (cell + 1u) * kCellBins; ++bin) {
        uint count = push.bins.v[bin];
        push.bins.v[bin] = total;
        total += count;
    }
    uint room = roomFor(total);
    if (total > push.cells.v[cell].room) {
        uint first = atomicAdd(HEAD.count, room);
        if (first + room > push.orderRoom) {
            HEAD.room = 1u;
            room = 0u;
            total = 0u;
            for (uint bin = cell * kCellBins; bin < (cell + 1u) * kCellBins; ++bin) push.bins.v[bin] = 0u;
        }
        push.cells.v[cell].first = first;
        push.cells.v[cell].room = room;
    }
    push.cells.v[cell].count = total;
}
