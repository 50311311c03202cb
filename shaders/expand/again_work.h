// Of branches with grown chunks: the nodes whose terminals are to be made, and the branches whose thickness may change.
#ifndef ESPALIER_EXPAND_AGAIN_WORK_H
#define ESPALIER_EXPAND_AGAIN_WORK_H
#include "records/expand_rows.h"
#include "shaders/expand/again.h"
#include "shaders/shared/rule_map.h"

ESPALIER_BEGIN

FN uint countBits(uint bits) {
#ifdef __cplusplus
    return uint(std::popcount(bits));
#else
    return uint(bitCount(bits));
#endif
}

// Whether every node of the branch depends on what has changed: its length, or a parameter of its terminals.
FN bool wholeBranch(ExpandEnv env, uint branch, uint first) {
    uint grammar = env.chunks.v[first].symbol >> 16u;
    bool asksLength = (env.tables.v[grammar * kGrammarTables_words + kGrammarTables_extrudeInputs] & kInputBranchLength) != 0u;
    bool longer = floatBitsToUint(env.branches.v[branch].extent) !=
                  floatBitsToUint(branch < AGAIN.branchCount ? AGAIN.branchesBefore.v[branch].extent : -1.0f);
    return (AGAIN_MARKS.v[branch].branchBits & kBranchRedo) != 0u || (asksLength && longer);
}

FN void listWork(ExpandEnv env, uint branch, uint first) {
    bool whole = wholeBranch(env, branch, first);
    UintBuf results = AGAIN.results;
    uint capacity = AGAIN.resultCapacity;
    for (uint chunk = first; chunk != kNoIndex;) {
        uint next = env.chunks.v[chunk].next;
        uint count = chunkNodes(env.chunks.v[chunk].marks);
        bool grown = (AGAIN_MARKS.v[chunk].bits & kMarkGrown) != 0u;
        bool nextGrown = next != kNoIndex && (AGAIN_MARKS.v[next].bits & kMarkGrown) != 0u;
        uint all = count >= 32u ? 0xFFFFFFFFu : (1u << count) - 1u;
        bool turned = (AGAIN_MARKS.v[chunk].bits & kMarkTurned) != 0u;
        // The last node before a grown chunk has another follower.
        uint ends = (turned ? 1u : 0u) | (nextGrown ? all & ~(all >> 1u) : 0u);
        uint nodes = whole || grown ? all : ends;
        if (nodes != 0u) {
            AGAIN_MARKS.v[chunk].nodes = nodes;
            uint firstNode = env.chunks.v[chunk].firstNode;
            uint kept = grown ? 0u : kResultKept;
            uint at = atomicAdd(AGAIN.counts[kListWork], countBits(nodes));
            for (uint left = nodes; left != 0u && at < capacity; left = left & (left - 1u)) {
                results.v[at] = (firstNode + lowestBit(left)) | kept;
                at = at + 1u;
            }
        }
        chunk = next;
    }
}

FN void listKin(ExpandEnv env, uint branch, uint first) {
    appendTo(env, kListKin, branch);
    uint visited = 0u;
    bool prune = false;
    for (uint at = nextChunk(env.chunks, first, first, false); at != kNoIndex;
         at = nextChunk(env.chunks, first, at, prune)) {
        uint kin = env.chunks.v[at].branch;
        prune = false;
        if (kin != kNoIndex && env.branches.v[kin].firstChunk == at) {
            prune = (AGAIN_MARKS.v[kin].branchBits & kBranchListed) != 0u;   // it comes in its own turn
            if (!prune) appendTo(env, kListKin, kin);
        }
        visited += 1u;
        if (visited > kMostVisited) {
            AGAIN.overrun = 1u;
            break;
        }
    }
}

// Item i of the branches with grown chunks.
FN void workAgain(ExpandEnv env, uint i) {
    uint branch = listEntry(env, kListBranches, i);
    uint first = env.branches.v[branch].firstChunk;
    if (first == kNoIndex) return;
    listWork(env, branch, first);
    listKin(env, branch, first);
}

ESPALIER_END
#endif
