// Flags and lists a node that was written, the spans that begin there, and other spans of their stretches. The text of a
// kernel, and in C++ of a member: `push` is around it, and bind_item.h.

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
    for (uint k = 0u; k < 4096u && child != kNoIndex; ++k) {
        if (push.chunks.v[child].previousNode == i && chunkNodes(push.chunks.v[child].marks) > 0u)
            flagStretch(push.chunks.v[child].firstNode,
                        push.chunks.v[child].firstNode + chunkNodes(push.chunks.v[child].marks),
                        push.chunks.v[child].firstNode);
        child = push.chunks.v[child].nextSibling;
    }
}

void touchNode(uint i) {
    flagNode(i, kFlagSpan);
    if (push.nodes.v[i].radius >= 0.0f) flagFollowers(i);
}
