// What the kernels of expansion share besides the growth itself: buffers, counters, waves, limits.
#ifndef ESPALIER_SHARED_EXPAND_ENV_H
#define ESPALIER_SHARED_EXPAND_ENV_H
#include "records/growth_records.h"
#include "records/staged_sample.h"
#include "shaders/shared/lanes.h"
#include "shaders/shared/rule_map.h"
#include "shaders/shared/waves.h"

ESPALIER_BEGIN

CONST_UINT(kExpandGroup, 32u);      // invocations of a group in every kernel of expansion
CONST_UINT(kNodesPerGroup, 128u);   // of the passes over nodes: what a group does once is shared by these
CONST_UINT(kHashSlots, 64u);        // sums of hashes are spread over these, so that threads don't queue for one
CONST_UINT(kDensityCells, 1u << 18u);

// ExpandEnv::phase of this pass.
CONST_UINT(kTerminalsWrite, 0u);
CONST_UINT(kTerminalsCount, 1u);   // only count leaves by cell, for the density cap
CONST_UINT(kTerminalsJoints, 2u);  // only sum branches' directions at their joints, for the paper's tangents
CONST_UINT(kTerminalsAgain, 3u);   // of a regrowth: leaves are written as pending, nodes' results aside
CONST_UINT(kLeafPending, 1u << 31u);   // of Leaf::node: not to be drawn yet

// Counters of one growth. Taken counts may exceed capacities: then nothing was written beyond them, and the host
// grows again with more room.
struct GrowStatus {
    uint chunks, nodes, branches, leaves;                                     // taken
    uint chunkCapacity, nodeCapacity, branchCapacity, leafCapacity;
    uint nodeGroups[3];      // VkDispatchIndirectCommand over the nodes that aren't frozen
    uint branchGroups[3];    // the same over the branches
    uint items;              // most items that a wave asked for, where that was too many
    uint steps, inserted, stopped, deadEnds, lost;
    uint frozenNodes, frozenBranches;   // the first ones: they stand as they are
    uint limitWave;          // in this wave only items whose key begins below limitKey are grown, in later ones none
    uint limitKey;
    uint walkMode, tangentMode;
    float leafDensityCap;    // leaves per m² and seed, 0: none
    uint mostLeaves;         // leafCapacity is no more; their count stays near it, lest it wrap
    uint spare;
    uint prunedCount;        // branches that are cut away: a branch whose key is among these isn't grown
    UintBuf pruned;          // [2 * i]: low words, high words of their keys, ascending
    u64 again;               // address of a regrowth's AgainState
    UintBuf firstLeaves;     // of a node, kNoIndex: none; and
    UintBuf nextLeaves;      // of a leaf the next one on its node: kernels alone write these, for regrowths
    // Of stems that keep a distance (expand_avoid.h):
    UintBuf avoidHeads;      // [avoidCells] of a hashed grid: the cell's first entry, kNoIndex: none
    UintBuf avoidEntries;    // [2 * entry]: the node at whose end a span lies there, the cell's next entry
    UintBuf avoidBounds;     // [chunk]: so many of its nodes stand, at least bits 7..0, at most bits 15..8; 23..16: how
                             // often it has grown before in vain
    float avoidReach;        // the largest distance of a grammar, 0: there is none
    float gridReach;         // a quarter of the grid's cells, no less than that
    uint gridNeed;           // bits of what it would have to be at least; 0: it is enough
    uint avoidCells;         // a power of two
    uint avoidCapacity, avoidTaken;   // entries
    uint frozenChunks;       // the first ones
    uint waveFirst;          // the first chunk that the latest wave has begun
    uint waveChunks, waveUndecided;   // and how many; those whose nodes may stand or not
    uint chunkGroups[3];     // VkDispatchIndirectCommand over these chunks
    uint cutNodes, cutBranches, cutChunks;   // gaps from the start: what came too near to others
    uint dropped;            // shapes that waited behind these
    uint hash[128];          // [slot * 2]: low words, high words
};
STATIC_SIZE(GrowStatus, 760);
BUFFER(GrowStatusBuf, GrowStatus)

// All that a kernel of expansion is handed, as push constants.
struct ExpandEnv {
    SurfaceBuf surfaces;
    LayerBuf layers;
    RuleMapBuf grammars;
    UintBuf tables;          // words
    WorkItemBuf items;       // this wave's
    WorkItemBuf nextItems;
    NodeBuf nodes;
    ChunkBuf chunks;
    BranchBuf branches;
    LeafBuf leaves;
    UintBuf scratch;         // native code's stage for a chunk's nodes
    GrowStatusBuf status;
    WaveBuf waves;
    UintBuf density;         // [kDensityCells] leaves counted, when there is a cap; after them, for the paper's
                             // tangents, [3 * node] directions of its branches in 2^-20
    uint wave;
    uint phase;              // of the terminal pass: see expand_terminals.h; in the march: the last wave that may be
                             // grown, pushes beyond it are refused
    uint itemCapacity;       // of each of the two queues
    uint spare;
};
STATIC_SIZE(ExpandEnv, 128);

CONST_UINT(kMostGroups, 65535u);        // of a dispatch
CONST_UINT(kLaneGroups, kMostLanes / kExpandGroup);   // of passes whose lanes have memory of their own
CONST_UINT(kLaneSlots, 128u);           // words of that memory where the machine's slots begin, and the chunk's samples
CONST_UINT(kLaneStage, kLaneSlots + kSlotWords);
CONST_UINT(kLaneWords, kLaneStage + kChunkNodes * kStagedSample_words);
// Some software devices end every loop after some 65,000 trips of all loops of an invocation together: so a chunk ends
// early after this many of its main loop, and an invocation takes no more items than these.
CONST_UINT(kMaxTrips, 256u);
CONST_UINT(kMostTaken, 4u);
// Items of a wave that one dispatch of the march grows at most: further ones are for another dispatch.
CONST_UINT(kDispatchItems, kLaneGroups * kExpandGroup * kMostTaken);
CONST_UINT(kItemsPerGroupAgain, 16u);   // of a regrowth: its few items shall not all go to one thread
#if defined(ESPALIER_AGAIN) && !defined(__cplusplus)   // native code knows no groups
CONST_UINT(kItemsPerGroup, kItemsPerGroupAgain);
#else
CONST_UINT(kItemsPerGroup, 64u);   // a group is dispatched for so many, fewer an invocation than it may take
#endif

#ifdef __cplusplus
// As in kernels, of no order with other memory.
inline uint atomicAdd(uint& memory, uint value) { return __atomic_fetch_add(&memory, value, __ATOMIC_RELAXED); }
inline uint atomicOr(uint& memory, uint value) { return __atomic_fetch_or(&memory, value, __ATOMIC_RELAXED); }
inline uint atomicExchange(uint& memory, uint value) { return __atomic_exchange_n(&memory, value, __ATOMIC_RELAXED); }
inline uint atomicMin(uint& memory, uint value) {
    uint old = __atomic_load_n(&memory, __ATOMIC_RELAXED);
    while (old > value && !__atomic_compare_exchange_n(&memory, &old, value, true, __ATOMIC_RELAXED, __ATOMIC_RELAXED)) {}
    return old;
}
inline uint atomicMax(uint& memory, uint value) {
    uint old = __atomic_load_n(&memory, __ATOMIC_RELAXED);
    while (old < value && !__atomic_compare_exchange_n(&memory, &old, value, true, __ATOMIC_RELAXED, __ATOMIC_RELAXED)) {}
    return old;
}
#endif

// A word of which others read meanwhile what stays the same.
#ifdef __cplusplus
inline uint loadShared(const uint& memory) { return __atomic_load_n(&memory, __ATOMIC_RELAXED); }
#define STORE_SHARED(memory, value) __atomic_store_n(&(memory), value, __ATOMIC_RELAXED)
#else
#define loadShared(memory) (memory)
#define STORE_SHARED(memory, value) memory = value
#endif

// Whether all that has grown found room.
FN bool roomForNodes(ExpandEnv env) {
    return env.status.v[0].nodes <= env.status.v[0].nodeCapacity &&
           env.status.v[0].chunks <= env.status.v[0].chunkCapacity &&
           env.status.v[0].branches <= env.status.v[0].branchCapacity && env.status.v[0].items == 0u;
}
// Whether branches are complete and all found room: not while waves are left, nor when something was lost.
FN bool complete(ExpandEnv env) {
    return roomForNodes(env) && env.waves.v[env.wave].count == 0u;
}

// Index of the lowest bit set; bits != 0.
FN uint lowestBit(uint bits) {
#ifdef __cplusplus
    return uint(std::countr_zero(bits));
#else
    return uint(findLSB(bits));
#endif
}

// Whether `key` is among the `count` ascending keys that begin at word `at`, low words first.
FN bool isAmong(UintBuf keys, uint at, uint count, u64 key) {
    uint first = 0u;
    uint end = count;
    while (first < end) {
        uint middle = (first + end) >> 1u;
        u64 there = (u64(keys.v[at + 2u * middle + 1u]) << 32) | u64(keys.v[at + 2u * middle]);
        if (there == key) return true;
        first = there < key ? middle + 1u : first;
        end = there < key ? end : middle;
    }
    return false;
}

// Two 32-bit hashes side by side: cheaper on every device than one of 64 bits.
FN uint stirred(uint h, uint word, uint odd) {
    h = (h ^ word) * odd;
    return h ^ (h >> 15u);
}
FN uvec2 hashWord(uvec2 h, uint word) { return uvec2(stirred(h.x, word, 0x85EBCA6Bu), stirred(h.y, word, 0xC2B2AE35u)); }
FN uvec2 hashVec3(uvec2 h, vec3 v) {
    return hashWord(hashWord(hashWord(h, floatBitsToUint(v.x)), floatBitsToUint(v.y)), floatBitsToUint(v.z));
}
// Adds to the structure's hash. slot: any, unlike ones for those who add at the same time.
FN void addHash(ExpandEnv env, uint slot, uvec2 hash) {
    uint at = (slot & (kHashSlots - 1u)) * 2u;
    atomicAdd(env.status.v[0].hash[at], hash.x);
    atomicAdd(env.status.v[0].hash[at + 1u], hash.y);
}
FN uvec2 hashKey(u64 key) { return uvec2(uint(key), uint(key >> 32)); }

// What a node adds to the structure's hash, key being its chunk's: all of it but where things lie in the buffers.
FN uvec2 hashOfNode(u64 key, Node node) {
    uvec2 h = hashVec3(hashKey(key), node.position);
    h = hashWord(hashWord(hashWord(h, node.normal), node.tangent), node.uv);
    h = hashWord(hashWord(hashWord(h, node.place), floatBitsToUint(node.radius)), floatBitsToUint(node.arc));
    return hashWord(h, node.flags);
}
// The same of a leaf on the node with these flags. Both can be worked out again from what is kept, so that a regrowth
// takes what it removes out of the sum.
FN uvec2 hashOfLeaf(u64 key, uint flags, Leaf leaf) {
    uvec2 h = hashWord(hashWord(hashWord(hashKey(key), leaf.place), leaf.pose), leaf.tint);
    return hashWord(h, 0x1EAF0000u | (flags & 0x1F00u));
}

// Groups of `each` for a dispatch over `count` items: as many as every device takes, which go on to the others.
FN uint groupsOf(uint count, uint each) {
    uint groups = (count + each - 1u) / each;
    return groups < kMostGroups ? groups : kMostGroups;
}
// What items [first, first + count) add to that.
FN uint groupsAdded(uint first, uint count, uint each) { return groupsOf(first + count, each) - groupsOf(first, each); }
// The same of passes whose lanes have memory of their own.
FN uint laneGroupsOf(uint count, uint each) {
    uint groups = groupsOf(count, each);
    return groups < kLaneGroups ? groups : kLaneGroups;
}
FN uint laneGroupsAdded(uint first, uint count, uint each) {
    return laneGroupsOf(first + count, each) - laneGroupsOf(first, each);
}

ESPALIER_END
#endif
