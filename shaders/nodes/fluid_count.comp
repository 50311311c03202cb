#version 460
#extension GL_GOOGLE_include_directive : require
// Particles -> their cells, and how many each cell holds.
#include "shaders/shared/extensions.glsl"
#include "shaders/shared/dispatch.glsl"
#include "shaders/shared/node_fluid.h"

layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Data { FluidArgs a; };

void main() {
    uint i = itemIndex();
    if (i >= a.count) return;
    uint cell = fluidCell(a, i);
    a.words.v[cellWord(a) + i] = cell;
    a.words.v[turnWord(a) + i] = atomicAdd(a.words.v[cell], 1u);
}
