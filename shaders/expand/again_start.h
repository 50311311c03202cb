// Dirty chunks with no dirty chunk before them are the first wave; the others wait for these. And leaves are chained to
// their nodes, where they aren't yet.
#ifndef ESPALIER_EXPAND_AGAIN_START_H
#define ESPALIER_EXPAND_AGAIN_START_H
#include "shaders/expand/again.h"

ESPALIER_BEGIN

// Chains a leaf that others than the terminal pass have put there.
FN void chainAgain(ExpandEnv env, UintBuf firstLeaves, UintBuf nextLeaves, uint leaf) {
    uint node = env.leaves.v[leaf].node;
    if (node != kNoIndex) nextLeaves.v[leaf] = atomicExchange(firstLeaves.v[node], leaf);
}

// Item i of the dirty chunks.
FN void startAgain(ExpandEnv env, uint i) {
    uint chunk = listEntry(env, kListDirty, i);
    uint below = chunk;
    uint above = env.chunks.v[chunk].parent;
    while (above != kNoIndex && (AGAIN_MARKS.v[above].bits & kMarkDirty) == 0u) {
        below = above;
        above = env.chunks.v[above].parent;
    }
    if (above == kNoIndex) {
        queueAgain(env, env.items, 0u, chunk, kItemsPerGroupAgain);
    } else {
        waitFor(env, chunk, below);
    }
}

ESPALIER_END
#endif
