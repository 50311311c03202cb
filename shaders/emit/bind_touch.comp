#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/extensions.glsl"
// When only a part is bound: a node each. Nodes that regrowths have written, and those whose spans begin there, are
// flagged; so are other spans of their stretches, which stay.
#include "shaders/emit/bind.glsl"

layout(local_size_x = 64) in;

const uint kMostChildren = 4096u;

// Of a chunk's nodes from `first` on and before `end`: the span that ends at `node`, and those of its stretch.
void flagStretch(uint first, uint end, uint node) {
    atomicOr(push.flags.v[node], kFlagSpan);
    uint from = node - (node - first) % kStretch;
    for (uint i = from; i < min(from + kStretch, end); ++i) atomicOr(push.flags.v[i], kFlagStretch);
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

void main() {
    uint i = itemIndex();
    if (i < kAllCells) push.cells.v[i].changed = 0u;
    if (i == kAllCells) HEAD.changed = 0u;
    bool wrote = i < push.nodeCount;
    for (bool old = wrote && i < push.nodesBefore; old; old = false) wrote = push.touched.v[i] > push.since;
    for (bool flagged = wrote; flagged; flagged = false) {
        atomicOr(push.flags.v[i], kFlagSpan);
        for (bool stands = push.nodes.v[i].radius >= 0.0; stands; stands = false) flagFollowers(i);
    }
}
