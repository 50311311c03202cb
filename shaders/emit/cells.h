// Cells of the grid that space is divided into.
#ifndef ESPALIER_EMIT_CELLS_H
#define ESPALIER_EMIT_CELLS_H
#include "shaders/emit/glsl_names.h"

ESPALIER_BEGIN

FN uint cellOf(IN(EmitGrid) grid, vec3 p) {
    vec3 last = vec3(grid.size[0], grid.size[1], grid.size[2]) - 1.0f;
    uvec3 c = uvec3(clamp(floor((p - grid.low) * grid.rcpCell), vec3(0.0f), last));
    return (c.z * grid.size[1] + c.y) * grid.size[0] + c.x;
}

FN vec3 cellMiddle(IN(EmitGrid) grid, uint cell) {
    uint row = cell / grid.size[0];
    uint z = row / grid.size[1];
    vec3 c = vec3(cell - row * grid.size[0], row - z * grid.size[1], z);
    return grid.low + (c + 0.5f) / grid.rcpCell;
}
// The bin of a span for which the last one of its stretch stands, by the stretch's error in metres.
FN uint errorBin(IN(EmitGrid) grid, float error) {
    float halvings = -log2(max(error * grid.rcpCell, 1e-6f));
    return uint(clamp(halvings * 8.0f, 0.0f, float(kCellBins - 1u)));
}
// In the order of items, for a cell of so many: some to spare.
FN uint roomFor(uint count) { return count > 0u ? count + count / 4u + 16u : 0u; }
FN uint cellCount(IN(EmitGrid) grid) { return grid.size[0] * grid.size[1] * grid.size[2]; }

ESPALIER_END
#endif
