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

// The next of the chunks that start where `root` does: it, and behind each without nodes those that follow from it.
// kNoIndex after the last.
uint nextStart(uint root, uint at) {
    uint next = chunkNodes(push.chunks.v[at].marks) > 0u ? kNoIndex : push.chunks.v[at].firstChild;
    while (next == kNoIndex && at != root) {
        next = push.chunks.v[at].nextSibling;
        at = push.chunks.v[at].parent;
    }
    return next;
}

void flagFollowers(uint i) {
    uint chunk = push.nodes.v[i].chunk;
    uint first = push.chunks.v[chunk].firstNode;
    uint end = first + chunkNodes(push.chunks.v[chunk].marks);
    flagStretch(first, end, i);
    if (i + 1u < end) flagStretch(first, end, i + 1u);
    uint child = push.chunks.v[chunk].firstChild;
    for (uint k = 0u; k < 4096u && child != kNoIndex; ++k) {
        uint at = push.chunks.v[child].previousNode == i ? child : kNoIndex;
        for (; at != kNoIndex; at = nextStart(child, at)) {
            uint start = push.chunks.v[at].firstNode;
            uint count = chunkNodes(push.chunks.v[at].marks);
            if (count > 0u) flagStretch(start, start + count, start);
        }
        child = push.chunks.v[child].nextSibling;
    }
}

// Whether a node that was bound stands on a surface that has moved since.
bool hasMoved(uint i) {
    if (push.movedWords == 0u) return false;
    uint instance = push.nodes.v[i].place >> 16u;
    return instance < 32u * push.movedWords && (push.moved[instance / 32u] >> (instance % 32u) & 1u) != 0u;
}

void touchNode(uint i) {
    flagNode(i, kFlagSpan);
    if (push.nodes.v[i].radius >= 0.0f) flagFollowers(i);
}
