#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/extensions.glsl"
// A host's picture and depth are what growth is drawn upon.
#include "shaders/render/encode.glsl"
#include "shaders/render/host_records.h"
#include "shaders/render/tone.glsl"

layout(push_constant, scalar) uniform Data { HostPush push; };
layout(set = 0, binding = 0) uniform sampler2D hostColor;
layout(set = 0, binding = 1) uniform sampler2D hostNear;
layout(location = 0) out vec4 color;

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    vec3 c = texelFetch(hostColor, at, 0).rgb;
    if (push.encoded != 0u) c = decodedColor(c);
    color = stored(c, 0.0);
    gl_FragDepth = texelFetch(hostNear, at, 0).x;
}
