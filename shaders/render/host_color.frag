#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/extensions.glsl"
// Growth, and edges that were smoothed with it, into a host's picture; all its other pixels stay as they are.
#include "shaders/render/encode.glsl"
#include "shaders/render/host_records.h"

layout(push_constant, scalar) uniform Data { HostPush push; };
layout(set = 0, binding = 0) uniform sampler2D picture;   // sRGB encoded
layout(set = 0, binding = 1) uniform sampler2D grown;
layout(location = 0) out vec4 color;

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    ivec2 last = textureSize(grown, 0) - 1;
    float nearest = 0.0;
    for (int y = -push.reach; y <= push.reach; ++y)
        for (int x = -push.reach; x <= push.reach; ++x)
            nearest = max(nearest, texelFetch(grown, clamp(at + ivec2(x, y), ivec2(0), last), 0).x);
    if (nearest == 0.0) discard;
    vec3 c = texelFetch(picture, at, 0).rgb;
    if (push.encoded == 0u) c = decodedColor(c);
    color = vec4(c, 1.0);
}
