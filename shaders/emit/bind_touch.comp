#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/extensions.glsl"
// When only a part is bound: a node each. Nodes that regrowths have written, and those whose spans begin there, are
// flagged.
#include "shaders/emit/bind.glsl"

layout(local_size_x = 64) in;

const uint kMostChildren = 4096u;

void flagFollowers(uint i) {
    uint chunk = push.nodes.v[i].chunk;
    uint end = push.chunks.v[chunk].firstNode + chunkNodes(push.chunks.v[chunk].marks);
    if (i + 1u < end) push.flags.v[i + 1u] = 1u;
    uint child = push.chunks.v[chunk].firstChild;
    for (uint k = 0u; k < kMostChildren && child != kNoIndex; ++k) {
        if (push.chunks.v[child].previousNode == i && chunkNodes(push.chunks.v[child].marks) > 0u)
            push.flags.v[push.chunks.v[child].firstNode] = 1u;
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
        push.flags.v[i] = 1u;
        for (bool stands = push.nodes.v[i].radius >= 0.0; stands; stands = false) flagFollowers(i);
    }
}
