#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/extensions.glsl"
// A host's depth -> ours.
#include "shaders/render/host_records.h"

layout(push_constant, scalar) uniform Data { HostPush push; };
layout(set = 0, binding = 0) uniform sampler2D hostDepth;
layout(location = 0) out float nearness;

void main() {
    float d = texelFetch(hostDepth, ivec2(gl_FragCoord.xy), 0).x;
    nearness = clamp((d - push.atInfinity) / push.perNearness * push.nearPlane, 0.0, 1.0);
}
