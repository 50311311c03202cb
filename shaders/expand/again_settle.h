// After the march: what is gone because no chunk asked for it again, and which branches have new chunks.
#ifndef ESPALIER_EXPAND_AGAIN_SETTLE_H
#define ESPALIER_EXPAND_AGAIN_SETTLE_H
#include "shaders/expand/again.h"

ESPALIER_BEGIN

// Chunks that followed from `root`, and it.
FN void letGo(ExpandEnv env, uint root) {
    ChunkBuf before = AGAIN.chunksBefore;
    uint visited = 0u;
    uint chunks = 0u;
    uint nodes = 0u;
    uint branches = 0u;
    for (uint at = root; at != kNoIndex; at = nextChunk(before, root, at, false)) {
        visited += 1u;
        if (visited > kMostVisited) {
            AGAIN.overrun = 1u;
            break;
        }
        appendTo(env, kListGone, at);
        chunks += 1u;
        nodes += chunkNodes(before.v[at].marks);
        uint branch = before.v[at].branch;
        if (branch != kNoIndex && AGAIN.branchesBefore.v[branch].firstChunk == at) {
            env.branches.v[branch].firstChunk = kNoIndex;
            branches += 1u;
        }
    }
    atomicAdd(AGAIN.goneChunks, chunks);
    atomicAdd(AGAIN.goneNodes, nodes);
    atomicAdd(AGAIN.goneBranches, branches);
}

// Item i of the grown chunks.
FN void settleAgain(ExpandEnv env, ChunkBuf before, uint i) {
    uint chunk = listEntry(env, kListGrown, i);
    uint branch = env.chunks.v[chunk].branch;
    if (branch != kNoIndex) listBranch(env, branch);
    if ((AGAIN_MARKS.v[chunk].bits & kMarkAgain) == 0u) return;
    atomicAdd(AGAIN.goneNodes, chunkNodes(before.v[chunk].marks));
    uint was = before.v[chunk].branch;   // if it began that, it has none now, or goes on with its parent's
    if (was != kNoIndex && branch != was && AGAIN.branchesBefore.v[was].firstChunk == chunk) {
        env.branches.v[was].firstChunk = kNoIndex;
        atomicAdd(AGAIN.goneBranches, 1u);
    }
    for (uint child = before.v[chunk].firstChild; child != kNoIndex; child = before.v[child].nextSibling)
        if ((AGAIN_MARKS.v[child].bits & (kMarkKept | kMarkAgain)) == 0u) letGo(env, child);
}

ESPALIER_END
#endif
