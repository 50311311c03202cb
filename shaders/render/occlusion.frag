#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/extensions.glsl"
// Ambient occlusion from distances alone: of two opposite neighbours, how much nearer is their mean than the middle?
// Slopes cancel out, creases and what lies behind leaves darken.
#include "shaders/render/frame.glsl"

layout(push_constant, scalar) uniform Data { PostPush push; };
layout(set = 0, binding = 0) uniform sampler2D distanceMap;
layout(location = 0) out float open;

const vec2 kTaps[6] = vec2[6](vec2(0.31, 0.11), vec2(-0.22, 0.52), vec2(0.64, -0.38), vec2(0.43, 0.79),
                              vec2(-0.97, 0.21), vec2(-0.30, -0.15));

const float kLeastOpen = 0.22;   // light bounced from what is near reaches everywhere

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    ivec2 last = textureSize(distanceMap, 0) - 1;
    float z = texelFetch(distanceMap, at, 0).x;
    if (z > 9e5) {
        open = 1.0;
        return;
    }
    float reach = 0.16 * frame.unit;
    float pixels = clamp(reach * frame.pixelScale * 0.5 / z, 2.0, 48.0);
    float metres = pixels * z / (frame.pixelScale * 0.5);
    float sum = 0.0;
    for (int i = 0; i < 6; ++i) {
        ivec2 d = ivec2(kTaps[i] * pixels);
        float a = texelFetch(distanceMap, clamp(at + d, ivec2(0), last), 0).x;
        float b = texelFetch(distanceMap, clamp(at - d, ivec2(0), last), 0).x;
        // How much nearer, told by reciprocals, which are linear over a plane's picture. Something much nearer is another
        // thing, not a neighbour that shades.
        float da = z * z / a - z;
        float db = z * z / b - z;
        da = da > 3.0 * metres ? 0.25 * metres : max(da, -3.0 * metres);
        db = db > 3.0 * metres ? 0.25 * metres : max(db, -3.0 * metres);
        float r = length(kTaps[i]) * metres;
        sum += clamp((da + db) * 0.5 / r - 0.06, 0.0, 1.0);
    }
    open = clamp(1.0 - 0.34 * sum, kLeastOpen, 1.0);
}
