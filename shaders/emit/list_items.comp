#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/extensions.glsl"
// A cell each: what is kept of it goes to the list, so that blocks are full.
#include "shaders/emit/emit_push.glsl"
#include "shaders/shared/dispatch.glsl"

layout(local_size_x = 64) in;

void main() {
    uint cell = itemIndex();
    uint kept = cell < kAllCells ? push.seen.v[cell] : 0u;
    if (kept > 0u) {
        uint from = push.cells.v[cell].first;
        uint to = push.seen.v[kAllCells + cell];
        for (uint i = 0u; i < kept; ++i) push.list.v[to + i] = push.order.v[from + i];
    }
}
