#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/extensions.glsl"
// Depths of a model of which one mesh takes over from another.
#include "shaders/render/fade.glsl"
#include "shaders/render/frame_records.h"

layout(push_constant, scalar) uniform Data { ModelPush push; };

void main() {
    if (fadedOut(push.fade, gl_FragCoord.xy)) discard;
}
