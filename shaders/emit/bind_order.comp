#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/extensions.glsl"
// Items are put into their bins.
#include "shaders/emit/bind.glsl"

layout(local_size_x = 64) in;

#include "shaders/emit/bind_cell.h"

void main() {
    uint items = itemsToPut();
    for (uint i = FIRST_LANE; i < items; i += LANES) putItem(itemToPut(i));
}
