#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/extensions.glsl"
// Level ground: one square that goes out far beyond where haze hides it.
#include "shaders/roof/draw_records.h"

layout(push_constant, scalar) uniform Data { RoofGroundPush push; };
layout(location = 0) out vec3 position;

void main() {
    uint corner = uint(gl_VertexIndex) % 6u;
    vec2 side = vec2(corner == 1u || corner == 2u || corner == 4u ? 1.0 : -1.0, corner == 2u || corner == 4u || corner == 5u ? 1.0 : -1.0);
    float far = 4.0 * push.reach + distance(push.frame.v[0].eye, push.center);
    position = push.center + vec3(side.x, 0.0, side.y) * far;
    gl_Position = push.frame.v[0].viewProjection * vec4(position, 1.0);
}
