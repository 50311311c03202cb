// The last pass: branches are made no thicker than their parents where they leave them, and the canonical hash of
// all nodes is summed.
#ifndef ESPALIER_SHARED_EXPAND_FIT_H
#define ESPALIER_SHARED_EXPAND_FIT_H
#include "shaders/shared/bezier.h"
#include "shaders/shared/record_lookup.h"

ESPALIER_BEGIN

CONST_UINT(kMaxForebears, 64u);

#ifndef ESPALIER_AGAIN
// A node's radius before the fit; a regrowth has its own way to it.
FN float bareRadius(ExpandEnv env, uint index) { return env.nodes.v[index].radius; }
#endif

// Thickness of a branch: s = min(1, q · s_parent), where q is the parent's radius at the joint over the branch's
// first. Unrolled, the smallest product of the first q's on the way to the seed, or 1.
FN float thicknessOf(ExpandEnv env, uint branch) {
    float product = 1.0f;
    float thickness = 1.0f;
    uint at = branch;
    for (uint i = 0u; i < kMaxForebears; ++i) {
        uint chunk = env.branches.v[at].firstChunk;
        uint joint = env.chunks.v[chunk].previousNode;
        if (joint == kNoIndex) break;
        uint first = env.chunks.v[chunk].firstNode;
        float mine = bareRadius(env, first);
        float parents = bareRadius(env, joint);
        if (mine > 0.0f && parents > 0.0f) product = product * divExact(parents, mine);
        thickness = smaller(thickness, product);
        at = env.chunks.v[env.nodes.v[joint].chunk].branch;
    }
    return larger(thickness, 1e-9f);
}

// Adds the branch's first direction to its joint's sum: in whole numbers, so that the order doesn't matter.
FN void sumJoint(ExpandEnv env, uint branch) {
    uint chunk = env.branches.v[branch].firstChunk;
    uint joint = env.chunks.v[chunk].previousNode;
    if (joint == kNoIndex) return;
    uint first = env.chunks.v[chunk].firstNode;
    vec3 from = readPosition(env, joint);
    vec3 d = segmentDirection(from, readPositionFrom(env, first, env.nodes.v[joint].place)) * 1048576.0f;
    uint at = kDensityCells + 3u * joint;
    atomicAdd(env.density.v[at], uint(int(d.x)));
    atomicAdd(env.density.v[at + 1u], uint(int(d.y)));
    atomicAdd(env.density.v[at + 2u], uint(int(d.z)));
}

// Fits the node's radius to its branch and returns its hash.
FN uvec2 fitNode(ExpandEnv env, uint index) {
    Node node = readNode(env, index);
    node.radius = node.radius * readBranch(env, readBranchOf(env, node.chunk)).thickness;
    env.nodes.v[index].radius = node.radius;
    return hashOfNode(readKey(env, node.chunk), node);
}

ESPALIER_END
#endif
