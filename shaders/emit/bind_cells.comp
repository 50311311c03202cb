#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/extensions.glsl"
// A cell each: room for its items in the order, and where its bins begin in that. Which cell comes first is of no
// account: views go through cells by their number.
#include "shaders/emit/bind.glsl"

layout(local_size_x = 64) in;

void main() {
    uint cell = itemIndex();
    if (cell >= 2u * kMaxCells) return;
    uint total = 0u;
    for (uint bin = cell * kCellBins; bin < (cell + 1u) * kCellBins; ++bin) {
        uint count = push.bins.v[bin];
        push.bins.v[bin] = total;
        total += count;
    }
    push.cells.v[cell].count = total;
    push.cells.v[cell].first = total > 0u ? atomicAdd(push.cells.v[2u * kMaxCells].count, total) : 0u;
}
