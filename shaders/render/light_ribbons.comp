#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/extensions.glsl"
// Ribbons of bark, one after the other: lit once at either end. Their vertices are those of Terminals' ribbons: two at each
// end, from one side to the other.
#include "shaders/render/bark_small_light.glsl"
#include "shaders/render/bark_vertex.glsl"
#include "shaders/render/lit.glsl"
#include "shaders/shared/dispatch.glsl"

layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Data { LightPush data; };

void main() {
    TerminalPush push = data.draw;
    uint i = itemIndex();
    if (i >= state.counts[push.bucket]) return;
    uint drawn = state.starts[push.bucket] + i;
    SpanInstance span = drawnSpan(drawn);
    float scale = smallBarkScale(span.radius0, span.radius1), fade = barkFade(span);
    float start = fract(span.arc0 * scale);   // as small as it can be: it becomes a half
    uint at = kLitWords * drawn;
    for (uint end = 0u; end < 2u; ++end) {
        BarkRing ring = barkRing(span, float(end), true);
        SmallBark light = smallBark(push, ring.center, ring.up, ring.radius);
        writeLight(data.lit, at, end, vec4(light.own, light.other.x), vec4(light.other.yz, light.share, fade));
        float along = start + span.metres * scale * float(end);
        for (uint k = 0u; k < 2u; ++k) {
            float x = 2.0 * float(k) - 1.0;
            writeLitVertex(data.lit, at, 2u * end + k, ring.center + ring.side * (x * ring.radius), vec2(0.5 * float(k), along));
        }
    }
}
