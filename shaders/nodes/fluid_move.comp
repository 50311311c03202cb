#version 460
#extension GL_GOOGLE_include_directive : require
// Particles and densities -> where they are a step later.
#include "shaders/shared/extensions.glsl"
#include "shaders/shared/dispatch.glsl"
#include "shaders/shared/node_fluid.h"

layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Data { FluidArgs a; };

void main() {
    uint i = itemIndex();
    if (i < a.count) moveFluid(a, i);
}
