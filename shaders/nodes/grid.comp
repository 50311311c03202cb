#version 460
#extension GL_GOOGLE_include_directive : require
// Numbers -> a grid of points.
#include "shaders/shared/extensions.glsl"
#include "shaders/shared/dispatch.glsl"
#include "shaders/shared/node_points.h"

layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Data { GridArgs a; };

void main() {
    uint i = itemIndex();
    if (i < a.total) placeGridPoint(a, i);
}
