#version 460
#extension GL_GOOGLE_include_directive : require
// Of branches with grown chunks: the nodes whose terminals are to be made, and the branches whose thickness may change.
#include "shaders/shared/extensions.glsl"
#include "shaders/shared/rule_map.h"
#include "shaders/expand/again.glsl"

layout(local_size_x = 32) in;
layout(push_constant, scalar) uniform Push { ExpandEnv env; };

// Whether every node of the branch depends on what has changed: its length, or a parameter of its terminals.
bool wholeBranch(ExpandEnv env, uint branch, uint first) {
    uint grammar = env.chunks.v[first].symbol >> 16u;
    bool asksLength = (env.tables.v[grammar * kGrammarWords + kTableExtrudeInputs] & kInputBranchLength) != 0u;
    bool longer = floatBitsToUint(env.branches.v[branch].extent) !=
                  floatBitsToUint(branch < AGAIN.branchCount ? AGAIN.branchesBefore.v[branch].extent : -1.0);
    return (againMarks.v[branch].branchBits & kBranchRedo) != 0u || (asksLength && longer);
}

void listWork(ExpandEnv env, uint branch, uint first) {
    bool whole = wholeBranch(env, branch, first);
    UintBuf results = AGAIN.results;
    uint capacity = AGAIN.resultCapacity;
    for (uint chunk = first; chunk != kNoIndex;) {
        uint next = env.chunks.v[chunk].next;
        uint count = chunkNodes(env.chunks.v[chunk].marks);
        bool grown = (againMarks.v[chunk].bits & kMarkGrown) != 0u;
        bool nextGrown = next != kNoIndex && (againMarks.v[next].bits & kMarkGrown) != 0u;
        uint all = count >= 32u ? 0xFFFFFFFFu : (1u << count) - 1u;
        // The last node before a grown chunk has another follower.
        uint nodes = whole || grown ? all : nextGrown ? all & ~(all >> 1u) : 0u;
        if (nodes != 0u) {
            againMarks.v[chunk].nodes = nodes;
            uint firstNode = env.chunks.v[chunk].firstNode;
            uint at = atomicAdd(AGAIN.counts[kListWork], bitCount(nodes));
            for (uint left = nodes; left != 0u && at < capacity; left = left & (left - 1u)) {
                results.v[kResultWords * at] = firstNode + lowestBit(left);
                at = at + 1u;
            }
        }
        chunk = next;
    }
}

void listKin(ExpandEnv env, uint branch, uint first) {
    appendTo(env, kListKin, branch);
    uint visited = 0u;
    bool prune = false;
    for (uint at = nextChunk(env.chunks, first, first, false); at != kNoIndex;
         at = nextChunk(env.chunks, first, at, prune)) {
        uint kin = env.chunks.v[at].branch;
        prune = false;
        if (kin != kNoIndex && env.branches.v[kin].firstChunk == at) {
            prune = (againMarks.v[kin].branchBits & kBranchListed) != 0u;   // it comes in its own turn
            if (!prune) appendTo(env, kListKin, kin);
        }
        visited += 1u;
        if (visited > kMostVisited) {
            AGAIN.overrun = 1u;
            break;
        }
    }
}

void main() {
    openAgain(env);
    if (!complete(env)) return;
    uint count = listed(env, kListBranches);
    uint lanes = gl_NumWorkGroups.x * kExpandGroup;
    for (uint i = gl_GlobalInvocationID.x; i < count; i += lanes) {
        uint branch = listEntry(env, kListBranches, i);
        uint first = env.branches.v[branch].firstChunk;
        if (first == kNoIndex) continue;
        listWork(env, branch, first);
        listKin(env, branch, first);
    }
}
