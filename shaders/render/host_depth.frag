#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/extensions.glsl"
// Growth's depth into a host's.
#include "shaders/render/host_records.h"

layout(push_constant, scalar) uniform Data { HostPush push; };
layout(set = 0, binding = 0) uniform sampler2D grown;

void main() {
    float nearest = texelFetch(grown, ivec2(gl_FragCoord.xy), 0).x;
    if (nearest == 0.0) discard;
    gl_FragDepth = clamp(push.atInfinity + push.perNearness * (nearest / push.nearPlane), 0.0, 1.0);
}
