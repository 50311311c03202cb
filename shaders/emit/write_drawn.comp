#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/extensions.glsl"
// What the classifying kernels have noted goes to its place among what is drawn.
#include "shaders/emit/emit_push.glsl"
#include "shaders/shared/dispatch.glsl"

layout(local_size_x = 64) in;
layout(set = 0, binding = 0) uniform usamplerBuffer noteTexels;

void main() {
    uint i = itemIndex();
    uint block = i / kBlockItems;
    if (block >= push.state.v[0].blocks[0] + push.state.v[0].blocks[1]) return;
    uvec4 note = texelFetch(noteTexels, int(i));
    uint bucket = note.w >> 24u;
    if (bucket != kNoBucket) {
        uint at = push.state.v[0].starts[bucket] + push.rows.v[block * kMaxBuckets + bucket] + (note.w & 0xFFFFFFu);
        push.drawn.v[at] = DrawnItem(note.x, note.y, uintBitsToFloat(note.z), 0u);
    }
}
