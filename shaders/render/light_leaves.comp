#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/extensions.glsl"
// Leaves of few pixels, one after the other: lit once, in their middle.
#include "shaders/render/leaf_small_light.glsl"
#include "shaders/render/lit.glsl"
#include "shaders/shared/dispatch.glsl"

layout(constant_id = kConstantCorners) const uint corners = 3;
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Data { LightPush data; };

// So that a moving picture is as bright as one at rest: measured.
const float kTowardsSun = 0.6, kBent = 1.02;

void main() {
    TerminalPush push = data.draw;
    uint i = itemIndex();
    if (i >= state.counts[push.bucket]) return;
    uint drawn = state.starts[push.bucket] + i;
    LeafInstance leaf = drawnLeaf(drawn);
    // Not an array: software devices would keep it in memory.
    LeafVertex a = leafVertexOf(leaf, drawnVertex(push.firstVertex)), b = leafVertexOf(leaf, drawnVertex(push.firstVertex + 1u));
    LeafVertex c = leafVertexOf(leaf, drawnVertex(push.firstVertex + 2u)), d = a, middle = a;
    float fourth = corners == 4u ? 1.0 : 0.0, share = 1.0 / (3.0 + fourth);
    if (corners == 4u) d = leafVertexOf(leaf, drawnVertex(push.firstVertex + 3u));
    middle.position = share * (a.position + b.position + c.position + fourth * d.position);
    middle.normal = normalize(a.normal + b.normal + c.normal + fourth * d.normal);
    middle.open = share * (a.open + b.open + c.open + fourth * d.open);
    // A flat leaf lies behind the bent one that has cast the shadow, and takes a little less light than it.
    middle.position += frame.sunDirection * (kTowardsSun * distance(a.position, c.position));
    SmallLeaf light = smallLeaf(push, middle);
    light.own *= kBent, light.turned *= kBent, light.mirrored *= kBent;
    uint at = kLitWords * drawn;
    writeLight(data.lit, at, 0u, vec4(light.own, light.turned.x), vec4(light.turned.yz, light.mirrored.xy));
    writeLight(data.lit, at, 1u, vec4(light.mirrored.z, light.share, 0.0, 0.0), vec4(0.0));
    vec2 pictured = vec2(0.0, light.pictured);
    writeLitVertex(data.lit, at, 0u, a.position, a.uv + pictured);
    writeLitVertex(data.lit, at, 1u, b.position, b.uv + pictured);
    writeLitVertex(data.lit, at, 2u, c.position, c.uv + pictured);
    if (corners == 4u) writeLitVertex(data.lit, at, 3u, d.position, d.uv + pictured);
}
