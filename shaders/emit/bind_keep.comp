#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/extensions.glsl"
// When only a part is bound: a cell each. What stays in a changed one is listed, to be put there again.
#include "shaders/emit/bind.glsl"

layout(local_size_x = 64) in;

void main() {
    uint cell = itemIndex();
    if (cell >= kAllCells || push.cells.v[cell].changed == 0u) return;
    uint first = push.cells.v[cell].first;
    uint count = push.cells.v[cell].count;
    for (uint i = 0u; i < count; ++i) {
        uint item = push.order.v[first + i];
        if ((push.keys.v[item] & kFresh) == 0u) push.list.v[atomicAdd(HEAD.changed, 1u)] = item;
    }
    for (uint b = 0u; b < kCellBins; ++b) push.bins.v[cell * kCellBins + b] = 0u;
    push.cells.v[cell].reach = 0u;
    push.cells.v[cell].largest = 0u;
}
