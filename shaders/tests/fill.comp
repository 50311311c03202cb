#version 460
// Writes each item's index times a factor: the smallest program with push data.
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/extensions.glsl"
#include "shaders/shared/dispatch.glsl"
#include "shaders/shared/language.h"

layout(local_size_x = 64) in;
BUFFER(Words, uint)
layout(push_constant, scalar) uniform Push {
    Words words;
    uint count;
    uint factor;
    uint repeat;   // the work of one item, to keep the GPU busy on purpose
};

void main() {
    uint i = itemIndex();
    if (i >= count) return;
    uint value = i * factor;
    for (uint k = 0; k < repeat; ++k) value = value * 1664525u + 1013904223u;
    words.v[i] = value;
}
