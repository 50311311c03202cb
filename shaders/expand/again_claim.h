// What a regrowth does otherwise when a chunk begins and ends; see expand_again.h. Included by expand_grow.h.
#ifndef ESPALIER_EXPAND_AGAIN_CLAIM_H
#define ESPALIER_EXPAND_AGAIN_CLAIM_H
#include "shaders/expand/again.h"

ESPALIER_BEGIN

FN uint previousNodeOf(ExpandEnv env, WorkItem item) {
    if ((item.step & kItemAgain) != 0u) return env.chunks.v[item.origin].previousNode;
    if (item.parent == kNoIndex) return kNoIndex;
    return item.origin == kNoIndex ? env.chunks.v[item.parent].previousNode
                                   : env.chunks.v[item.parent].firstNode + item.origin;
}
FN uint joinSiblings(ExpandEnv env, WorkItem item, uint chunk) {
    if ((item.step & kItemAgain) != 0u) return env.chunks.v[chunk].nextSibling;   // it stands among them
    return item.parent == kNoIndex ? kNoIndex : atomicExchange(env.chunks.v[item.parent].firstChild, chunk);
}

// Passes of a regrowth go through lists by themselves.
FN void askNodeGroups(ExpandEnv env, uint first, uint count) {
    UNUSED(env);
    UNUSED(first);
    UNUSED(count);
}
FN void askBranchGroups(ExpandEnv env, uint branch) {
    UNUSED(env);
    UNUSED(branch);
}

// A branch whose first chunk is grown again stays the same.
FN uint claimBranch(ExpandEnv env, uint chunk) {
    if ((AGAIN_MARKS.v[chunk].bits & kMarkAgain) != 0u) {
        uint branch = AGAIN.chunksBefore.v[chunk].branch;
        if (branch != kNoIndex && AGAIN.branchesBefore.v[branch].firstChunk == chunk) return branch;
    }
    return atomicAdd(env.status.v[0].branches, 1u);
}

// The child that the item's parent had with the item's key before it was grown again.
FN uint childBefore(ExpandEnv env, WorkItem item) {
    if (item.parent == kNoIndex || (AGAIN_MARKS.v[item.parent].bits & kMarkAgain) == 0u) return kNoIndex;
    ChunkBuf before = AGAIN.chunksBefore;
    uint child = before.v[item.parent].firstChild;
    while (child != kNoIndex && before.v[child].key != item.key) child = before.v[child].nextSibling;
    return child;
}

FN bool sameBits(float a, float b) { return floatBitsToUint(a) == floatBitsToUint(b); }
FN bool entersAlike(Chunk c, WorkItem item) {
    bool alike = c.depth == item.depth && (c.step & 0xFFFFFFu) == (item.step & 0xFFFFFFu) && c.symbol == item.symbol &&
                 (item.branch == kNoIndex || item.branch == c.branch) && c.entry.place == item.walk.place;
    for (uint i = 0u; i < 4u; ++i) alike = alike && sameBits(c.args[i], item.args[i]);
    return alike && sameBits(c.entry.uv.x, item.walk.uv.x) && sameBits(c.entry.uv.y, item.walk.uv.y) &&
           sameBits(c.entry.direction.x, item.walk.direction.x) &&
           sameBits(c.entry.direction.y, item.walk.direction.y) &&
           sameBits(c.entry.direction.z, item.walk.direction.z) && sameBits(c.entry.arc, item.walk.arc);
}

// Whether two nodes lie in one place to the bit: where a step goes over an edge of a triangle, the node that it begins at
// is laid on the triangle beyond (expand_stage.h), so it hangs on what follows.
FN bool samePlace(ExpandEnv env, uint a, uint b) {
    vec3 p = env.nodes.v[a].position;
    vec3 q = env.nodes.v[b].position;
    return sameBits(p.x, q.x) && sameBits(p.y, q.y) && sameBits(p.z, q.z);
}

// Gives a kept chunk the node that it now starts from, and so those that follow from it before its first step. Their
// first nodes' tangents follow from its place.
FN void moveFoot(ExpandEnv env, uint chunk, uint node) {
    uint old = env.chunks.v[chunk].previousNode;
    bool turns = false;
    // A node beyond is nowhere: all is done again.
    if (old != node && node < env.status.v[0].nodeCapacity) turns = !samePlace(env, old, node);
    uint at = old == node ? kNoIndex : chunk;
    while (at != kNoIndex) {
        bool moves = env.chunks.v[at].previousNode == old;
        if (moves) env.chunks.v[at].previousNode = node;
        if (moves && turns && chunkNodes(env.chunks.v[at].marks) > 0u) {
            atomicOr(AGAIN_MARKS.v[at].bits, kMarkTurned);   // who grows it again may be marking it
            listBranch(env, env.chunks.v[at].branch);
        }
        at = nextChunk(env.chunks, chunk, at, !moves);
    }
}

FN void keepChunk(ExpandEnv env, uint chunk, WorkItem item) {
    AGAIN_MARKS.v[chunk].bits |= kMarkKept;
    moveFoot(env, chunk, previousNodeOf(env, item));
    env.chunks.v[chunk].nextSibling = atomicExchange(env.chunks.v[item.parent].firstChild, chunk);
    if (item.branch != kNoIndex) {
        env.chunks.v[item.parent].next = chunk;
        env.branches.v[item.branch].extent = AGAIN.branchesBefore.v[item.branch].extent;
    }
    uint waiting = AGAIN_MARKS.v[chunk].firstWaiting;
    while (waiting != 0u) {
        queueAgain(env, env.nextItems, env.wave + 1u, waiting - 1u, kItemsPerGroupAgain);
        waiting = AGAIN_MARKS.v[waiting - 1u].nextWaiting;
    }
}

// Those that waited at a chunk that is now grown itself wait further down.
FN void waitBelow(ExpandEnv env, uint chunk) {
    uint waiting = AGAIN_MARKS.v[chunk].firstWaiting;
    while (waiting != 0u) {
        uint dirty = waiting - 1u;
        waiting = AGAIN_MARKS.v[dirty].nextWaiting;
        uint below = dirty;
        uint above = env.chunks.v[dirty].parent;
        while (above != chunk) {
            below = above;
            above = env.chunks.v[above].parent;
        }
        waitFor(env, dirty, below);
    }
}

// The place where the item's chunk is to be grown. False: it stays as it was, or there is no room.
FN bool claimChunk(ExpandEnv env, INOUT(WorkItem) item, OUT(uint) chunk) {
    bool again = (item.step & kItemAgain) != 0u;
    chunk = again ? item.origin : childBefore(env, item);
    bool old = chunk != kNoIndex;
    if (old && !again && (AGAIN_MARKS.v[chunk].bits & kMarkDirty) == 0u &&
        entersAlike(AGAIN.chunksBefore.v[chunk], item)) {
        keepChunk(env, chunk, item);
        return false;
    }
    if (old) {
        waitBelow(env, chunk);
    } else {
        chunk = atomicAdd(env.status.v[0].chunks, 1u);
    }
    if (chunk >= env.status.v[0].chunkCapacity) return false;
    AGAIN_MARKS.v[chunk].bits |= old ? kMarkGrown | kMarkAgain : kMarkGrown;
    appendTo(env, kListGrown, chunk);
    return true;
}

ESPALIER_END
#endif
