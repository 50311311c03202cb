#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/extensions.glsl"
// When only a part is bound: four nodes each. Nodes that regrowths have written or whose surfaces have moved, and those
// whose spans begin there, are flagged and listed; so are other spans of their stretches, which stay.
#include "shaders/emit/bind.glsl"

layout(local_size_x = 64) in;

#include "shaders/emit/touch_node.h"

uvec4 numbersOf(uint first) {
    uvec4 numbers = uvec4(0u);
    for (uint k = 0u; k < 4u; ++k)
        if (push.written != 0u && first + k < push.nodesBefore) numbers[k] = push.touched.v[first + k];
    return numbers;
}

void main() {
    uint lane = itemIndex();
    if (lane < kAllCells) push.cells.v[lane].changed = 0u;
    uint first = 4u * lane;
    uvec4 numbers = uvec4(0u);
    if (first < push.nodesBefore) numbers = numbersOf(first);
    bool wrote = first + 4u > push.nodesBefore || any(greaterThan(numbers, uvec4(push.since)));
    bool some = first < push.nodeCount && (wrote || push.movedWords != 0u);
    if (some) {
        for (uint k = 0u; k < 4u; ++k) {
            uint i = first + k;
            bool touched = i < push.nodeCount && (i >= push.nodesBefore || numbers[k] > push.since || hasMoved(i));
            if (touched) touchNode(i);
        }
    }
}
