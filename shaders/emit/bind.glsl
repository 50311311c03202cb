// What the kernels that bind growth share: their inputs, and how an item is put into its cell.
#ifndef ESPALIER_EMIT_BIND_GLSL
#define ESPALIER_EMIT_BIND_GLSL
#include "shaders/emit/cells.glsl"
#include "shaders/shared/dispatch.glsl"

layout(push_constant, scalar) uniform Data { BindPush push; };

// kind: 0 a span, 1 a leaf; order: its order of going, [0, 1); large: what EmitCell::largest is of.
void putIntoCell(uint item, uint kind, vec3 center, float reach, float large, float order) {
    uint cell = cellOf(push.grid, center);
    float far = distance(center, cellMiddle(push.grid, cell)) + reach;
    cell += kind * kMaxCells;
    uint bin = cell * kCellBins + min(uint(order * float(kCellBins)), kCellBins - 1u);
    atomicAdd(push.bins.v[bin], 1u);
    atomicMax(push.cells.v[cell].reach, floatBitsToUint(far));
    atomicMax(push.cells.v[cell].largest, floatBitsToUint(large));
    push.keys.v[item] = bin;
}
#endif
