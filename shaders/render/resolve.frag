#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/extensions.glsl"
// Samples -> pixels: occlusion, background, exposure and tone curve for each sample, then their mean, so that bright
// edges are as smooth as dark ones.
#include "shaders/render/frame_records.h"

layout(push_constant, scalar) uniform Data { PostPush push; };
layout(set = 0, binding = 0) uniform sampler2DMS colorMap;
layout(set = 0, binding = 1) uniform sampler2D openMap;
layout(location = 0) out vec4 color;

vec3 background() {
    vec2 at = gl_FragCoord.xy * push.rcpSize * 2.0 - 1.0;
    vec3 ray = normalize(push.frame.v[0].rayForward + push.frame.v[0].rayRight * at.x - push.frame.v[0].rayUp * at.y);
    float up = ray.y;
    vec3 sky = mix(push.frame.v[0].horizon, push.frame.v[0].background, sqrt(clamp(up * 1.1, 0.0, 1.0)));
    vec3 below = mix(push.frame.v[0].horizon, push.frame.v[0].groundColor * 1.2, clamp(-up * 3.0, 0.0, 1.0));
    float glow = max(dot(ray, push.frame.v[0].sunDirection), 0.0);
    return (up > 0.0 ? sky : below) + push.frame.v[0].sunColor * 0.05 * pow(glow, 12.0);
}

// A filmic curve: linear in the shadows, a soft shoulder, and bright colours lose their saturation instead of
// breaking off at one channel.
vec3 toneMapped(vec3 c) {
    float peak = max(c.x, max(c.y, c.z));
    c = mix(c, vec3(peak), 0.35 * smoothstep(0.8, 6.0, peak));
    vec3 x = c * 0.62;
    return clamp((x * (2.51 * x + 0.03)) / (x * (2.43 * x + 0.59) + 0.14), 0.0, 1.0);
}

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    float open = texture(openMap, gl_FragCoord.xy * push.rcpSize).x;
    bool shaded = push.frame.v[0].view == kViewShaded;
    vec3 behind = vec3(-1.0);
    vec3 sum = vec3(0.0);
    for (int i = 0; i < 4; ++i) {
        vec4 s = texelFetch(colorMap, at, i);
        vec3 c = s.rgb * (1.0 - s.a * (1.0 - open));
        if (s.a < 0.0) {
            if (behind.x < 0.0) behind = background();
            c = behind;
        }
        sum += shaded || s.a < 0.0 ? toneMapped(c * push.frame.v[0].exposure) : clamp(c, 0.0, 1.0);
    }
    sum *= 0.25;
    if (push.encode != 0u)
        sum = mix(sum * 12.92, 1.055 * pow(max(sum, vec3(1e-6)), vec3(1.0 / 2.4)) - 0.055, greaterThan(sum, vec3(0.0031308)));
    color = vec4(sum, 1.0);
}
