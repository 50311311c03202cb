#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/extensions.glsl"
// Ambient occlusion from distances alone: of two opposite neighbours, how much nearer is their mean than the middle?
// Slopes cancel out, creases and what lies behind leaves darken. Four pixels ask in turned directions and at other
// distances, and open.glsl takes their mean: else each tap would draw a faint copy of every edge.
#include "shaders/render/frame.glsl"

layout(push_constant, scalar) uniform Data { PostPush push; };
layout(set = 0, binding = 0) uniform sampler2D distanceMap;
layout(location = 0) out float open;

const vec2 kTaps[6] = vec2[6](vec2(0.31, 0.11), vec2(-0.22, 0.52), vec2(0.64, -0.38), vec2(0.43, 0.79),
                              vec2(-0.97, 0.21), vec2(-0.30, -0.15));

// Cosine and sine of a quarter of what lies between two taps, times how far out.
const vec2 kTurns[4] = vec2[4](vec2(1.12, 0.0), vec2(0.92, 0.25), vec2(0.70, 0.41), vec2(0.70, 0.70));
const float kLeastOpen = 0.34;   // light bounced from what is near reaches everywhere

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
    vec2 turn = kTurns[(at.x & 1) + 2 * (at.y & 1)];
    float perReach = 0.5 / (length(turn) * metres);
    float sum = 0.0;
    for (int i = 0; i < 6; ++i) {
        vec2 tap = vec2(kTaps[i].x * turn.x - kTaps[i].y * turn.y, kTaps[i].x * turn.y + kTaps[i].y * turn.x);
        ivec2 d = ivec2(tap * pixels);
        float a = texelFetch(distanceMap, clamp(at + d, ivec2(0), last), 0).x;
        float b = texelFetch(distanceMap, clamp(at - d, ivec2(0), last), 0).x;
        // How much nearer, told by reciprocals, which are linear over a plane's picture. The nearer something is to the eye
        // the less it is a neighbour that shades.
        float da = max(z * z / a - z, -3.0 * metres);
        float db = max(z * z / b - z, -3.0 * metres);
        da = min(da, max(2.5 * metres - 1.5 * da, 0.0));
        db = min(db, max(2.5 * metres - 1.5 * db, 0.0));
        sum += clamp((da + db) * perReach / length(kTaps[i]) - 0.06, 0.0, 1.0);
    }
    open = clamp(1.0 - 0.34 * sum, kLeastOpen, 1.0);
}
