#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/extensions.glsl"
// A plane's depth is linear over the picture: one triangle over all of it, cut off at the horizon, where depth is 0.
#include "shaders/render/frame.glsl"

layout(push_constant, scalar) uniform Data { PostPush push; };

void main() {
    vec2 at = vec2((gl_VertexIndex & 1) * 4 - 1, (gl_VertexIndex & 2) * 2 - 1);
    float down = frame.rayForward.y + frame.rayRight.y * at.x - frame.rayUp.y * at.y;
    gl_Position = vec4(at, frame.nearPlane * down / (frame.groundLevel - frame.eye.y), 1.0);
}
