#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/extensions.glsl"
// A loose terminal each, on the span that bind_spans has made: an instance in the world, put into its cell.
#include "shaders/emit/watch.glsl"
#include "shaders/emit/instance_texels.glsl"
#include "shaders/emit/leaf_place.h"
#include "shaders/shared/expand_env.h"

layout(local_size_x = 64) in;
layout(set = 0, binding = 0, scalar) uniform TableBlock { EmitTable table; };
layout(set = 0, binding = 1) uniform usamplerBuffer spanTexels;

void addTriangles(uint count) { atomicAdd(HEAD.first, count); }
SpanInstance spanInstance(uint i) { return SPAN_INSTANCE(spanTexels, i); }
Leaf readLeaf(uint i) { return push.leaves.v[i]; }

void writeLeaf(uint i, LeafInstance o) { writeLeafInstance(push.leafInstances, i, o); }

#include "shaders/emit/bind_leaf.h"

// All of them; or those on nodes whose spans were bound anew, and those that there weren't before.
void main() {
    uint listed = push.partly != 0u ? min(HEAD.largest, push.leavesBefore) : 0u;
    uint count = push.partly != 0u ? listed + push.leafCount - push.leavesBefore : push.leafCount;
    for (uint i = FIRST_LANE; i < count; i += LANES) {
        uint leaf = push.partly != 0u ? push.leavesBefore + i - listed : i;
        if (i < listed) leaf = push.work.v[push.leafWork + i];
        bindLeaf(leaf);
    }
}
