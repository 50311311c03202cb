// The tone curve and what the scene's image holds.
#ifndef ESPALIER_RENDER_TONE_GLSL
#define ESPALIER_RENDER_TONE_GLSL
#include "shaders/render/encode.glsl"
#include "shaders/render/frame.glsl"

// A filmic curve: linear in the shadows, a soft shoulder, and bright colours lose their saturation instead of
// breaking off at one channel.
vec3 toneMapped(vec3 c) {
    c = max(c, vec3(0.0));   // below it the curve rises again
    float peak = max(c.x, max(c.y, c.z));
    // By night eyes tell only lit things' colours; what is dark is grey with a little blue.
    float grey = frame.night * 0.72 * (1.0 - smoothstep(0.10, 0.55, peak));
    c = mix(c, dot(c, vec3(0.3, 0.6, 0.1)) * vec3(0.84, 0.98, 1.30), grey);
    c = mix(c, vec3(peak), 0.35 * smoothstep(0.8, 6.0, peak));
    vec3 x = c * 0.62;
    return clamp((x * (2.51 * x + 0.03)) / (x * (2.43 * x + 0.59) + 0.14), 0.0, 1.0);
}

// What the scene's image holds: the square root of the tone-mapped colour, and in w the share of it that came from
// the sky, which ambient occlusion dims later. 8 bits and a curve before samples are averaged: edges between bright
// and dark come out as smooth as others, and writing four samples stays cheap.
layout(constant_id = kConstantOutput) const uint passOutput = kOutputStored;
vec4 stored(vec3 mapped, float skyShare) {
    if (passOutput == kOutputStored) return vec4(sqrt(mapped), skyShare);
    return vec4(passOutput == kOutputEncoded ? encodedColor(mapped, sqrt(mapped)) : mapped, 1.0);
}
// light: times exposure.
vec4 sceneColor(vec3 light, float skyShare) {
    return passOutput == kOutputLight ? vec4(light, 1.0) : stored(toneMapped(light), skyShare);
}
// Counts instead of colours: each fragment adds this to its pixel.
const float kOverdrawStep = 8.0 / 255.0;
vec4 oneFragment() { return vec4(vec3(kOverdrawStep), 0.0); }
#endif
