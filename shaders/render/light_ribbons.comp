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

// at: of the instance; end: 0 or 1; along: texture coordinate there.
void lightEnd(uint at, SpanInstance span, uint end, float along) {
    DrawnRing ring = drawnRing(span, float(end), true);
    SmallBark light = smallBark(data.draw, ring.center, ring.up, ring.radius);
    writeLight(data.lit, at, end, vec4(light.own, light.other.x), vec4(light.other.yz, light.share, barkFade(span)));
    vec3 aside = ring.side * ring.radius;
    writeLitVertex(data.lit, at, 2u * end, ring.center - aside, vec2(0.0, along));
    writeLitVertex(data.lit, at, 2u * end + 1u, ring.center + aside, vec2(0.5, along));
}

void main() {
    uint i = itemIndex();
    if (i >= state.counts[data.draw.bucket]) return;
    uint drawn = state.starts[data.draw.bucket] + i;
    SpanInstance span = drawnSpan(drawn);
    float scale = smallBarkScale(span.radius0, span.radius1);
    float start = fract(span.arc0 * scale);   // as small as it can be: it becomes a half
    lightEnd(kLitWords * drawn, span, 0u, start);
    lightEnd(kLitWords * drawn, span, 1u, start + span.metres * scale);
}
