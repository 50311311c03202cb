#version 460
#extension GL_GOOGLE_include_directive : require
// Numbers -> corners of triangles.
#include "shaders/shared/extensions.glsl"
#include "shaders/shared/dispatch.glsl"
#include "shaders/shared/node_loft.h"

layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Data { SheetArgs a; };

void main() {
    uint i = itemIndex();
    if (i < a.quads) putQuad(a, i);
}
