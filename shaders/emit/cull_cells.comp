#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/extensions.glsl"
// A cell of spans or of leaves each: is any of it seen, and how many of its items can be kept?
#include "shaders/emit/cells.h"
#include "shaders/emit/emit_inputs.glsl"
#include "shaders/emit/leaf_thinning.h"
#include "shaders/emit/sight.h"
#include "shaders/emit/span_thinning.h"
#include "shaders/shared/dispatch.glsl"
#include "shaders/emit/keep_cell.h"

layout(local_size_x = 64) in;

void main() {
    uint i = itemIndex();
    if (i < kAllCells) push.seen.v[i] = keptOfCell(i);
}
