#version 460
#extension GL_GOOGLE_include_directive : require
// Keys -> samples of curves.
#include "shaders/shared/extensions.glsl"
#include "shaders/shared/dispatch.glsl"
#include "shaders/shared/node_curves.h"

layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Data { CurveArgs a; };

void main() {
    uint i = itemIndex();
    if (i < a.curves * a.samples) sampleCurve(a, curvePlace(a, i / a.curves), i / a.curves, i % a.curves);
}
