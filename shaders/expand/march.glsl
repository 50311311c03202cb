// One wave of the queue. Chunks are unlike in length, and lanes run in lockstep: when half of a subgroup's lanes have
// ended theirs, these are published and the lanes take further items.
#include "shaders/shared/expand_grow.h"

layout(local_size_x = 32) in;
layout(push_constant, scalar) uniform Push { ExpandEnv env; };

void main() {
    uint wanted = env.waves.v[env.wave].count;
    uint count = min(wanted, env.itemCapacity);
    if (wanted > count) atomicMax(env.status.v[0].items, wanted);
    bool more = env.waves.v[env.wave].taken < count;   // groups come late to what others have taken
#ifdef ESPALIER_AGAIN
    openAgain(env);
#endif
    ChunkGrowth c;
    c.g.phase = kPhaseEnded;
    bool live = false;
    uint taken = 0u;
    GrowthTally tally = emptyTally();
    while (subgroupAny(live || more)) {
        if (!live && more) {
            uint i = atomicAdd(env.waves.v[env.wave].taken, 1u);
            bool there = i < count;
            if (there) live = beginChunk(env, readWorkItem(env.items, i), c);
            taken = taken + 1u;
            more = there && (taken < kMostTaken || count > kMostGroups * kItemsPerGroup);
        }
        uint few = subgroupAny(more) ? min(gl_SubgroupSize, gl_WorkGroupSize.x) / 2u : 0u;
        uint busy = few + 1u;
        while (busy > few) {
            if (live && growing(c.g)) growOn(env, c);
            busy = subgroupBallotBitCount(subgroupBallot(live && growing(c.g)));
        }
        if (live && !growing(c.g)) {
            endChunk(env, c, tally);
            live = false;
        }
    }
    addTally(env, tally);
}
