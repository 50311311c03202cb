#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/extensions.glsl"
// When only a part is bound: a cell each.
#include "shaders/emit/bind.glsl"

layout(local_size_x = 64) in;

#include "shaders/emit/bind_cell.h"

void main() {
    uint cell = itemIndex();
    if (cell < kAllCells && push.cells.v[cell].changed != 0u) keepItems(cell);
}
