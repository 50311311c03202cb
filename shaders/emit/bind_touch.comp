#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/extensions.glsl"
// When only a part is bound: four nodes each. Nodes that regrowths have written, and those whose spans begin there, are
// flagged and listed; so are other spans of their stretches, which stay.
#include "shaders/emit/bind.glsl"

layout(local_size_x = 64) in;
layout(constant_id = 3) const uint kRecordsByAddress = 1u;
layout(set = 0, binding = 0) uniform usamplerBuffer touchedTexels;

const uint kMostChildren = 4096u;

// A node is listed when it is flagged first.
void flagNode(uint node, uint flag) {
    if (atomicOr(push.flags.v[node], flag) == 0u)
        push.work.v[atomicAdd(HEAD.reach, 1u)] = node;
}

// Of a chunk's nodes from `first` on and before `end`: the span that ends at `node`, and those of its stretch.
void flagStretch(uint first, uint end, uint node) {
    flagNode(node, kFlagSpan);
    uint from = node - (node - first) % kStretch;
    for (uint i = from; i < min(from + kStretch, end); ++i) flagNode(i, kFlagStretch);
}

void flagFollowers(uint i) {
    uint chunk = push.nodes.v[i].chunk;
    uint first = push.chunks.v[chunk].firstNode;
    uint end = first + chunkNodes(push.chunks.v[chunk].marks);
    flagStretch(first, end, i);
    if (i + 1u < end) flagStretch(first, end, i + 1u);
    uint child = push.chunks.v[chunk].firstChild;
    for (uint k = 0u; k < kMostChildren && child != kNoIndex; ++k) {
        if (push.chunks.v[child].previousNode == i && chunkNodes(push.chunks.v[child].marks) > 0u)
            flagStretch(push.chunks.v[child].firstNode,
                        push.chunks.v[child].firstNode + chunkNodes(push.chunks.v[child].marks),
                        push.chunks.v[child].firstNode);
        child = push.chunks.v[child].nextSibling;
    }
}

uvec4 numbersOf(uint first) {
    if (kRecordsByAddress == 0u) return texelFetch(touchedTexels, int(first / 4u));
    uvec4 numbers = uvec4(0u);
    for (uint k = 0u; k < 4u; ++k)
        if (first + k < push.nodesBefore) numbers[k] = push.touched.v[first + k];
    return numbers;
}

void main() {
    uint lane = itemIndex();
    if (lane < kAllCells) push.cells.v[lane].changed = 0u;
    uint first = 4u * lane;
    uvec4 numbers = uvec4(0u);
    if (first < push.nodesBefore) numbers = numbersOf(first);
    bool some = first < push.nodeCount && (first + 4u > push.nodesBefore || any(greaterThan(numbers, uvec4(push.since))));
    if (some) {
        for (uint k = 0u; k < 4u; ++k) {
            uint i = first + k;
            bool wrote = i < push.nodeCount && (i >= push.nodesBefore || numbers[k] > push.since);
            if (wrote) {
                flagNode(i, kFlagSpan);
                if (push.nodes.v[i].radius >= 0.0) flagFollowers(i);
            }
        }
    }
}
