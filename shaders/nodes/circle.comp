#version 460
#extension GL_GOOGLE_include_directive : require
// Numbers -> samples of a circle.
#include "shaders/shared/extensions.glsl"
#include "shaders/shared/dispatch.glsl"
#include "shaders/shared/node_curves.h"

layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Data { CircleArgs a; };

void main() {
    uint i = itemIndex();
    if (i < a.samples) sampleCircle(a, i);
}
