#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/extensions.glsl"
// The sky where nothing else is: horizon to zenith, a haze around the sun.
#include "shaders/render/tone.glsl"

layout(push_constant, scalar) uniform Data { PostPush push; };
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

void main() { color = stored(toneMapped(background() * push.frame.v[0].exposure), 0.0); }
