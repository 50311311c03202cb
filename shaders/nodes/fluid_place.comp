#version 460
#extension GL_GOOGLE_include_directive : require
// Particles -> places in their cells, in any order.
#include "shaders/shared/extensions.glsl"
#include "shaders/shared/dispatch.glsl"
#include "shaders/shared/node_fluid.h"

layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Data { FluidArgs a; };

void main() {
    uint i = itemIndex();
    if (i < a.count) placeFluid(a, i);
}
