// What all passes of a regrowth begin with; see expand_again.h.
#ifndef ESPALIER_EXPAND_AGAIN_H
#define ESPALIER_EXPAND_AGAIN_H
#include "shaders/shared/exact.h"
#include "shaders/shared/expand_again.h"

ESPALIER_BEGIN

#ifdef __cplusplus
#define AGAIN (*reinterpret_cast<AgainState*>(env.status.v[0].again))
#define AGAIN_LISTS AGAIN.lists
#define AGAIN_MARKS AGAIN.marks
#define AGAIN_CAPACITY AGAIN.listCapacity
#elif defined(ESPALIER_LANES)
// Read each time, so that the march's registers are free for the walk.
#define AGAIN AgainStateBuf(env.status.v[0].again).v[0]
#define AGAIN_LISTS AGAIN.lists
#define AGAIN_MARKS AGAIN.marks
#define AGAIN_CAPACITY AGAIN.listCapacity
#else
// Kept at hand from openAgain() on, the first thing that a kernel does: what is read by address costs each time.
AgainStateBuf againState;
UintBuf againLists;
AgainMarkBuf againMarks;
uint againListCapacity;
#define AGAIN againState.v[0]
#define AGAIN_LISTS againLists
#define AGAIN_MARKS againMarks
#define AGAIN_CAPACITY againListCapacity

void openAgain(ExpandEnv env) {
    againState = AgainStateBuf(env.status.v[0].again);
    againLists = AGAIN.lists;
    againMarks = AGAIN.marks;
    againListCapacity = AGAIN.listCapacity;
}
#endif

FN void appendTo(ExpandEnv env, uint list, uint value) {
    uint at = atomicAdd(AGAIN.counts[list], 1u);
    if (at < AGAIN_CAPACITY) AGAIN_LISTS.v[list * AGAIN_CAPACITY + at] = value;
}
FN uint listed(ExpandEnv env, uint list) {
    uint count = AGAIN.counts[list];
    return count < AGAIN_CAPACITY ? count : AGAIN_CAPACITY;
}
FN uint listEntry(ExpandEnv env, uint list, uint i) { return AGAIN_LISTS.v[list * AGAIN_CAPACITY + i]; }

// Whether what was grown is whole and has room; then it is published.
FN bool holds(ExpandEnv env) {
    uint nodes = AGAIN.liveNodes + env.status.v[0].nodes - AGAIN.nodeCount - AGAIN.goneNodes;
    uint chunks = AGAIN.liveChunks + env.status.v[0].chunks - AGAIN.chunkCount - AGAIN.goneChunks;
    return complete(env) && AGAIN.overrun == 0u && env.status.v[0].leaves <= env.status.v[0].leafCapacity &&
           nodes <= AGAIN.mostNodes && chunks <= AGAIN.mostChunks;
}

FN uint seedOf(BranchBuf branches, ChunkBuf chunks, uint chunk) {
    uint branch = chunks.v[chunk].branch;
    return branch == kNoIndex ? chunks.v[chunk].firstNode : branches.v[branch].seed;
}

// A node's radius before the fit: as its terminals have just given it, or told from what the last fit made of it.
FN float bareRadius(ExpandEnv env, uint index) {
    float radius = env.nodes.v[index].radius;
    uint chunk = env.nodes.v[index].chunk;
    bool fresh = ((AGAIN_MARKS.v[chunk].nodes >> ((env.nodes.v[index].flags >> 8u) & 31u)) & 1u) != 0u;
    if (fresh) return radius;
    return roundRadius(divExact(radius, AGAIN.branchesBefore.v[env.chunks.v[chunk].branch].thickness));
}

FN bool startsBranch(ChunkBuf chunks, uint chunk) {
    uint parent = chunks.v[chunk].parent;
    return parent == kNoIndex || (chunks.v[parent].depth & 0xFFFFu) != (chunks.v[chunk].depth & 0xFFFFu);
}

// The next chunk of those that follow from `root`, parents first; kNoIndex after the last. prune: not those that
// follow from `at`.
FN uint nextChunk(ChunkBuf chunks, uint root, uint at, bool prune) {
    uint child = prune ? kNoIndex : chunks.v[at].firstChild;
    while (child == kNoIndex && at != root) {
        child = chunks.v[at].nextSibling;
        at = chunks.v[at].parent;
    }
    return child;
}

// An item that grows a chunk again in its place.
FN WorkItem itemAgain(ExpandEnv env, uint chunk) {
    WorkItem item = {};
    item.key = env.chunks.v[chunk].key;
    item.walk = env.chunks.v[chunk].entry;
    item.symbol = env.chunks.v[chunk].symbol;
    for (uint i = 0u; i < 4u; ++i) item.args[i] = env.chunks.v[chunk].args[i];
    item.parent = env.chunks.v[chunk].parent;
    item.origin = chunk;
    item.branch = startsBranch(env.chunks, chunk) ? kNoIndex : env.chunks.v[chunk].branch;
    item.seed = seedOf(env.branches, env.chunks, chunk);
    item.depth = env.chunks.v[chunk].depth;
    item.step = (env.chunks.v[chunk].step & 0xFFFFFFu) | kItemAgain;
    return item;
}
FN void queueAgain(ExpandEnv env, WorkItemBuf items, uint wave, uint chunk, uint itemsPerGroup) {
    uint at = atomicAdd(env.waves.v[wave].count, 1u);
    if (at < env.itemCapacity) writeWorkItem(items, at, itemAgain(env, chunk));
    uint before = atomicAdd(env.waves.v[wave].announced, 1u);
    uint added = laneGroupsAdded(before, 1u, itemsPerGroup);
    if (added > 0u) atomicAdd(env.waves.v[wave].groups[0], added);
}

FN void listBranch(ExpandEnv env, uint branch) {
    if ((atomicOr(AGAIN_MARKS.v[branch].branchBits, kBranchListed) & kBranchListed) == 0u)
        appendTo(env, kListBranches, branch);
}

// Lets a dirty chunk wait for `above`, which is grown before it. Its own children need not: they are found dirty.
FN void waitFor(ExpandEnv env, uint chunk, uint below) {
    if (below == chunk) return;
    uint next = atomicExchange(AGAIN_MARKS.v[below].firstWaiting, chunk + 1u);
    AGAIN_MARKS.v[chunk].nextWaiting = next;
}

ESPALIER_END
#endif
