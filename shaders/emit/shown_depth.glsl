// Bits 7..3 of an instance: branches that lead to this node from its seed, if the view asks. Included after `push` is
// declared.
uint shownDepth(uint node) {
    if ((view.flags & kShowDepth) == 0u) return 0u;
    return min(push.chunks.v[push.nodes.v[node].chunk].depth & 0xFFFFu, 31u) << 3u;
}
