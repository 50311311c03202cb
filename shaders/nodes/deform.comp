#version 460
#extension GL_GOOGLE_include_directive : require
// Positions and a program -> positions, and normals where they are asked for.
#include "shaders/shared/extensions.glsl"
#include "shaders/shared/dispatch.glsl"
#include "shaders/shared/node_deform.h"

layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Data { DeformArgs a; };

void main() {
    uint i = itemIndex();
    if (i >= a.to.count) return;
    deformElement(a, i);
    if (IS_GIVEN(a.toNormals)) deformNormal(a, i);
}
