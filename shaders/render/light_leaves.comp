#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/extensions.glsl"
// Leaves of few pixels, one after the other: lit once, in their middle.
#include "shaders/render/leaf_small_light.glsl"
#include "shaders/render/lit.glsl"
#include "shaders/shared/dispatch.glsl"

layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Data { LightPush data; };

void main() {
    TerminalPush push = data.draw;
    uint i = itemIndex();
    if (i >= state.counts[push.bucket]) return;
    uint drawn = state.starts[push.bucket] + i;
    LeafInstance leaf = drawnLeaf(drawn);
    LeafVertex v[4], middle;
    for (uint k = 0u; k < 4u; ++k) v[k] = leafVertexOf(leaf, drawnVertex(push.firstVertex + k));
    middle = v[0];
    middle.position = 0.25 * (v[0].position + v[1].position + v[2].position + v[3].position);
    middle.normal = normalize(v[0].normal + v[1].normal + v[2].normal + v[3].normal);
    middle.open = 0.25 * (v[0].open + v[1].open + v[2].open + v[3].open);
    SmallLeaf light = smallLeaf(push, middle);
    uint at = kLitWords * drawn;
    writeLight(data.lit, at, 0u, vec4(light.own, light.turned.x), vec4(light.turned.yz, light.mirrored.xy));
    writeLight(data.lit, at, 1u, vec4(light.mirrored.z, light.share, 0.0, 0.0), vec4(0.0));
    for (uint k = 0u; k < 4u; ++k)
        writeLitVertex(data.lit, at, k, v[k].position, v[k].uv + vec2(0.0, light.pictured));
}
