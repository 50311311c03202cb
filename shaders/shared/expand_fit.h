// The last pass: branches are made no thicker than their parents where they leave them, and the canonical hash of
// all nodes is summed.
#ifndef ESPALIER_SHARED_EXPAND_FIT_H
#define ESPALIER_SHARED_EXPAND_FIT_H
#include "shaders/shared/bezier.h"
#include "shaders/shared/expand_env.h"

ESPALIER_BEGIN

CONST_UINT(kMaxForebears, 64u);

// Thickness of a branch: s = min(1, q · s_parent), where q is the parent's radius at the joint over the branch's
// first. Unrolled, the smallest product of the first q's on the way to the seed, or 1.
FN void fitBranch(ExpandEnv env, uint branch) {
    float product = 1.0f;
    float thickness = 1.0f;
    uint at = branch;
    for (uint i = 0u; i < kMaxForebears; ++i) {
        uint chunk = env.branches.v[at].firstChunk;
        uint joint = env.chunks.v[chunk].previousNode;
        if (joint == kNoIndex) break;
        uint first = env.chunks.v[chunk].firstNode;
        float mine = env.nodes.v[first].radius;
        float parents = env.nodes.v[joint].radius;
        if (mine > 0.0f && parents > 0.0f) product = product * divExact(parents, mine);
        thickness = smaller(thickness, product);
        at = env.chunks.v[env.nodes.v[joint].chunk].branch;
    }
    env.branches.v[branch].thickness = thickness;
}

// Adds the branch's first direction to its joint's sum: in whole numbers, so that the order doesn't matter.
FN void sumJoint(ExpandEnv env, uint branch) {
    uint chunk = env.branches.v[branch].firstChunk;
    uint joint = env.chunks.v[chunk].previousNode;
    if (joint == kNoIndex) return;
    uint first = env.chunks.v[chunk].firstNode;
    vec3 d = segmentDirection(env.nodes.v[joint].position, env.nodes.v[first].position) * 1048576.0f;
    uint at = kDensityCells + 3u * joint;
    atomicAdd(env.density.v[at], uint(int(d.x)));
    atomicAdd(env.density.v[at + 1u], uint(int(d.y)));
    atomicAdd(env.density.v[at + 2u], uint(int(d.z)));
}

// Scales the node's radius and returns its hash: of everything but where things lie in the buffers.
FN uvec2 fitNode(ExpandEnv env, uint index) {
    Node node = env.nodes.v[index];
    u64 key = env.chunks.v[node.chunk].key;
    node.radius = node.radius * env.branches.v[env.chunks.v[node.chunk].branch].thickness;
    env.nodes.v[index].radius = node.radius;
    uvec2 h = hashVec3(hashKey(key), node.position);
    h = hashWord(hashWord(hashWord(h, node.normal), node.tangent), node.uv);
    h = hashWord(hashWord(hashWord(h, node.place), floatBitsToUint(node.radius)), floatBitsToUint(node.arc));
    return hashWord(h, node.flags);
}

ESPALIER_END
#endif
