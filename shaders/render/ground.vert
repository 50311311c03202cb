#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/extensions.glsl"
// A plane's depth is linear over the picture: one triangle over all of it, cut off at the horizon, where depth is 0.
#include "shaders/render/frame_records.h"

layout(push_constant, scalar) uniform Data { PostPush push; };

void main() {
    FrameBuf frame = push.frame;
    vec2 at = vec2((gl_VertexIndex & 1) * 4 - 1, (gl_VertexIndex & 2) * 2 - 1);
    float down = frame.v[0].rayForward.y + frame.v[0].rayRight.y * at.x - frame.v[0].rayUp.y * at.y;
    gl_Position = vec4(at, frame.v[0].nearPlane * down / (frame.v[0].groundLevel - frame.v[0].eye.y), 1.0);
}
