#version 460
#extension GL_GOOGLE_include_directive : require
// Frames along curves and a ring -> vertices of tubes.
#include "shaders/shared/extensions.glsl"
#include "shaders/shared/dispatch.glsl"
#include "shaders/shared/node_loft.h"

layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Data { LoftArgs a; };

void main() {
    uint i = itemIndex();
    if (i >= a.curves * a.samples * a.ringSamples) return;
    uint c = i % a.curves, u = i / a.curves % a.ringSamples, j = i / a.curves / a.ringSamples;
    placeLoftVertex(a, ringPlace(a, j, u), j, u, c);
}
