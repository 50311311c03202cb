#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/extensions.glsl"
// When only a part is bound: some lanes a cell.
#include "shaders/emit/bind.glsl"

layout(local_size_x = 64) in;
layout(constant_id = kConstantLanes) const uint kCellLanes = 1u;

#include "shaders/emit/bind_cell.h"

void main() {
    uint cell = itemIndex() / kCellLanes;
    uint lane = itemIndex() % kCellLanes;
    if (cell < kAllCells && push.cells.v[cell].changed != 0u) keepItems(cell, lane, kCellLanes);
}
