#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/extensions.glsl"
// A cell each.
#include "shaders/emit/bind.glsl"

layout(local_size_x = 64) in;

#include "shaders/emit/bind_cell.h"

void main() {
    uint cell = itemIndex();
    if (push.partly == 0u && cell == kAllCells) HEAD.changed = push.nodeCount + push.leafCount;
    if (cell < kAllCells && (push.partly == 0u || push.cells.v[cell].changed != 0u)) makeCellRoom(cell);
}
