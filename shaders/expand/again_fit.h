// The end of a regrowth: thickness of the branches that it may have changed, radii that follow, the structure's hash.
#ifndef ESPALIER_EXPAND_AGAIN_FIT_H
#define ESPALIER_EXPAND_AGAIN_FIT_H
#include "shaders/expand/again.h"
#include "shaders/shared/expand_fit.h"

ESPALIER_BEGIN

// Item i of the branches whose thickness may change.
FN void thickenAgain(ExpandEnv env, uint i) {
    uint branch = listEntry(env, kListKin, i);
    float thickness = thicknessOf(env, branch);
    float before = branch < AGAIN.branchCount ? AGAIN.branchesBefore.v[branch].thickness : -1.0f;
    bool other = floatBitsToUint(thickness) != floatBitsToUint(before);
    bool work = (AGAIN_MARKS.v[branch].branchBits & kBranchListed) != 0u;
    env.branches.v[branch].thickness = thickness;
    uint chunk = other || work ? env.branches.v[branch].firstChunk : kNoIndex;
    while (chunk != kNoIndex) {
        if (other || AGAIN_MARKS.v[chunk].nodes != 0u) appendTo(env, kListFit, chunk);
        chunk = env.chunks.v[chunk].next;
    }
}

// As fitNode, of node `lane` of a chunk.
FN void fitAgain(ExpandEnv env, BranchBuf branchesBefore, uint chunk, ChunkBrief brief, uint lane, INOUT(uvec2) hash) {
    uint index = brief.firstNode + lane;
    Node node = readNode(env, index);
    // Others were taken out of the hash before, and have their radius from their terminals.
    bool fresh = ((AGAIN_MARKS.v[chunk].nodes >> lane) & 1u) != 0u;
    for (uint old = 0u; old < (fresh ? 0u : 1u); ++old) {
        hash -= hashOfNode(brief.key, node);
        node.radius = roundRadius(divExact(node.radius, branchesBefore.v[brief.branch].thickness));
    }
    node.radius = node.radius * readBranch(env, brief.branch).thickness;
    env.nodes.v[index].radius = node.radius;
    AGAIN.touched.v[index] = AGAIN.number;
    hash += hashOfNode(brief.key, node);
}

// A pending leaf is drawn from now on.
FN void showLeaf(ExpandEnv env, uint i) { env.leaves.v[i].node = env.leaves.v[i].node & ~kLeafPending; }

ESPALIER_END
#endif
