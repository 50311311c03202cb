#version 460
#extension GL_GOOGLE_include_directive : require
// Particles in any order -> by their numbers in each cell.
#include "shaders/shared/extensions.glsl"
#include "shaders/shared/dispatch.glsl"
#include "shaders/shared/node_fluid.h"

layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Data { FluidArgs a; };

void main() {
    uint i = itemIndex();
    if (i < a.count) orderFluid(a, i);
}
