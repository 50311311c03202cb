#version 460
#extension GL_GOOGLE_include_directive : require
// A fluid -> cells without particles.
#include "shaders/shared/extensions.glsl"
#include "shaders/shared/dispatch.glsl"
#include "shaders/shared/node_fluid.h"

layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Data { FluidArgs a; };

void main() {
    uint i = itemIndex();
    if (i < fluidCells(a)) a.words.v[i] = 0u;
    if (i == 0u) a.words.v[takenWord(a)] = 0u;
}
