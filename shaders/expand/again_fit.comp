#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_KHR_shader_subgroup_ballot : require
#define ESPALIER_AGAIN
#define ESPALIER_RECORD_FETCH
// The end of a regrowth: radii, the structure's hash, and leaves: pending ones are shown, those of touched nodes go.
#include "shaders/shared/extensions.glsl"
#include "shaders/expand/again.glsl"
#include "shaders/expand/again_lookup.glsl"
#include "shaders/shared/expand_fit.h"

layout(local_size_x = 32) in;
layout(push_constant, scalar) uniform Push { ExpandEnv env; };

uvec2 hash = uvec2(0u);

// As fitNode, with what the chunk's nodes share at hand.
void fitChunks(uint lane) {
    BranchBuf branchesBefore = AGAIN.branchesBefore;
    uint count = listed(env, kListFit);
    for (uint i = gl_WorkGroupID.x; i < count; i += gl_NumWorkGroups.x) {
        uint chunk = listEntry(env, kListFit, i);
        ChunkBrief brief = readBrief(env, chunk);
        bool there = lane < chunkNodes(brief.marks);
        for (uint k = 0u; k < (there ? 1u : 0u); ++k) {
            u64 key = brief.key;
            uint branch = brief.branch;
            uint index = brief.firstNode + lane;
            Node node = readNode(env, index);
            // Others were taken out of the hash before, and have their radius from their terminals.
            bool fresh = ((againMarks.v[chunk].nodes >> lane) & 1u) != 0u;
            for (uint old = 0u; old < (fresh ? 0u : 1u); ++old) {
                hash -= hashOfNode(key, node);
                node.radius = roundRadius(divExact(node.radius, branchesBefore.v[branch].thickness));
            }
            node.radius = node.radius * readBranch(env, branch).thickness;
            env.nodes.v[index].radius = node.radius;
            hash += hashOfNode(key, node);
        }
    }
}

// Whether leaves of nodes in this range may have to go.
bool touches(UintBuf touched, uint low, uint high) {
    bool any = low <= high && high - low > kWideRange;
    for (uint word = low >> 5u; word <= high >> 5u && low <= high && !any; ++word) {
        uint bits = touched.v[word];
        bits = word == low >> 5u ? bits & (0xFFFFFFFFu << (low & 31u)) : bits;
        bits = word == high >> 5u ? bits & (0xFFFFFFFFu >> (31u - (high & 31u))) : bits;
        any = bits != 0u;
    }
    return any;
}

// Lets leaf `i` go if its node is touched; 1 if so.
uint sweepLeaf(ChunkBuf before, UintBuf touched, uint i) {
    Leaf leaf = readLeaf(env, i);
    uint node = leaf.node;
    bool goes = node < kLeafPending && ((touched.v[node >> 5u] >> (node & 31u)) & 1u) != 0u;
    for (uint k = 0u; k < (goes ? 1u : 0u); ++k) {
        NodeArc was = readArc(env, node);
        hash -= hashOfLeaf(readKeyBefore(before, was.chunk), was.flags, leaf);
        env.leaves.v[i].node = kNoIndex;
    }
    return goes ? 1u : 0u;
}

// A lane looks at a block's range; the blocks that are met are swept by the lanes together.
uint sweepLeaves() {
    UintBuf ranges = AGAIN.leafRanges;
    UintBuf touched = AGAIN.touched;
    ChunkBuf before = AGAIN.chunksBefore;
    uint gone = 0u;
    uint count = AGAIN.leafCount;
    uint blocks = (count + kLeafBlock - 1u) / kLeafBlock;
    uint lanes = gl_NumWorkGroups.x * kExpandGroup;
    uint lane = gl_SubgroupInvocationID;
    for (uint first = gl_GlobalInvocationID.x - lane; first < blocks; first += lanes) {
        uint block = min(first + lane, blocks - 1u);
        bool met = first + lane < blocks && touches(touched, ranges.v[2u * block], ranges.v[2u * block + 1u]);
        uvec4 ballot = subgroupBallot(met);
        while (subgroupBallotBitCount(ballot) > 0u) {
            uint bit = subgroupBallotFindLSB(ballot);
            ballot[bit >> 5u] &= ~(1u << (bit & 31u));
            uint from = (first + bit) * kLeafBlock;
            for (uint i = from + lane; i < min(from + kLeafBlock, count); i += gl_SubgroupSize) gone += sweepLeaf(before, touched, i);
        }
    }
    for (uint i = count + gl_GlobalInvocationID.x; i < env.status.v[0].leaves; i += lanes)
        env.leaves.v[i].node = readLeaf(env, i).node & ~kLeafPending;
    return gone;
}

void main() {
    openAgain(env);
    if (!holds(env)) return;
    fitChunks(gl_LocalInvocationID.x);
    uint gone = sweepLeaves();
    if (gone > 0u) atomicAdd(AGAIN.goneLeaves, gone);
    uint slot = (gl_WorkGroupID.x & (kHashSlots - 1u)) * 2u;
    atomicAdd(env.status.v[0].hash[slot], hash.x);
    atomicAdd(env.status.v[0].hash[slot + 1u], hash.y);
}
