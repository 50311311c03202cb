// Cells of the grid that space is divided into.
#ifndef ESPALIER_EMIT_CELLS_GLSL
#define ESPALIER_EMIT_CELLS_GLSL
#include "shaders/emit/emit_records.h"

uint cellOf(EmitGrid grid, vec3 p) {
    vec3 last = vec3(grid.size[0], grid.size[1], grid.size[2]) - 1.0;
    uvec3 c = uvec3(clamp(floor((p - grid.low) * grid.rcpCell), vec3(0.0), last));
    return (c.z * grid.size[1] + c.y) * grid.size[0] + c.x;
}

vec3 cellMiddle(EmitGrid grid, uint cell) {
    uint row = cell / grid.size[0];
    uint z = row / grid.size[1];
    vec3 c = vec3(cell - row * grid.size[0], row - z * grid.size[1], z);
    return grid.low + (c + 0.5) / grid.rcpCell;
}
// The bin of a span for which the last one of its stretch stands, by the stretch's error in metres.
uint errorBin(EmitGrid grid, float error) {
    float halvings = -log2(max(error * grid.rcpCell, 1e-6));
    return uint(clamp(halvings * 8.0, 0.0, float(kCellBins - 1u)));
}
// In the order of items, for a cell of so many: some to spare.
uint roomFor(uint count) { return count > 0u ? count + count / 4u + 16u : 0u; }
uint cellCount(EmitGrid grid) { return grid.size[0] * grid.size[1] * grid.size[2]; }
#endif
