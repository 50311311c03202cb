// What the kernels that carry bound growth over share.
#ifndef ESPALIER_EMIT_CARRY_GLSL
#define ESPALIER_EMIT_CARRY_GLSL
#include "shaders/emit/emit_records.h"
#include "shaders/shared/dispatch.glsl"

layout(constant_id = kConstantMoved) const uint kMoved = 1u;   // 0: nodes and leaves have the numbers that they had
layout(push_constant, scalar) uniform Data { CarryPush push; };

uint nodeNow(uint node) {
    if (kMoved == 0u) return node;
    return push.nodesWent.v[node];
}
uint leafNow(uint leaf) {
    if (kMoved == 0u) return leaf;
    return push.leavesWent.v[leaf];
}
// Of a chain: kNoIndex, where it ends.
uint linkNow(uint leaf) {
    uint now = kNoIndex;
    if (leaf < push.leafCount) now = leafNow(leaf);
    return now;
}
#endif
