#version 460
#extension GL_GOOGLE_include_directive : require
// Samples of curves -> frames that turn as little as they can.
#include "shaders/shared/extensions.glsl"
#include "shaders/shared/dispatch.glsl"
#include "shaders/shared/node_loft.h"

layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Data { FrameArgs a; };

void main() {
    uint i = itemIndex();
    if (i < a.curves) sweepFrames(a, i);
}
