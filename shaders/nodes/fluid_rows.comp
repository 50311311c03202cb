#version 460
#extension GL_GOOGLE_include_directive : require
// Numbers of particles -> places of cells. Which row takes which places is nobody's concern.
#include "shaders/shared/extensions.glsl"
#include "shaders/shared/dispatch.glsl"
#include "shaders/shared/node_fluid.h"

layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Data { FluidArgs a; };

void main() {
    uint i = itemIndex();
    if (i < a.cells[1] * a.cells[2]) startRow(a, i, atomicAdd(a.words.v[takenWord(a)], placesInRow(a, i)));
}
