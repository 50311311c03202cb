#pragma once

// The kernels of growth as native code: their own text compiled as C++ (-ffp-contract=off), so it leaves the same bits.
// The CPU reference runs it on one thread. On software devices it runs on all, over the very memory that shaders would
// use: lanes of such a device share one core, and code that can leave out what a lane doesn't need is faster there.
//
// All addresses in an ExpandEnv are pointers here. Nothing else may use that memory meanwhile.

#include <array>

#include "runtime/core/growth_watch.hpp"
#include "runtime/core/jobs.hpp"
#include "shaders/shared/expand_env.h"

namespace espalier {

// The two queues, of env.itemCapacity items each; wave w is in [w & 1].
using ItemQueues = std::array<WorkItem*, 2>;

// Packs the tables of env's first `grammars` grammars, whose heads stand in env.tables (expand_tables.h).
void packTablesNative(ExpandEnv env, uint32_t grammars);

// Grows waves from env.wave on until one is empty or the next would be `most`, env.phase being the last that may be
// grown. Returns the first wave that didn't run, or, if `watch` stops it, one that didn't run whole. wide: chunks are
// grown side by side, their walks in the processor's vectors (wide_walk.hpp); the CPU reference grows them one by one.
uint32_t marchNative(ExpandEnv env, const ItemQueues& queues, uint32_t most, Crew& crew, bool wide,
                     GrowthWatch* watch = nullptr);

// The passes after wave env.wave: terminals, fit and the structure's hash. Nothing, unless growth is complete.
// env.density must be zero where the status asks for it. What `watch` stops isn't whole.
void terminalsNative(ExpandEnv env, Crew& crew, GrowthWatch* watch = nullptr);
void fitNative(ExpandEnv env, Crew& crew);

// A regrowth's: the links that are drawn are copied to env's, chunks found that are to be grown again, and the first
// wave put into env.items;
void findNative(ExpandEnv env, Crew& crew);
// its waves, as marchNative; and all that follows after wave env.wave: nothing, unless what was grown is whole and
// fits.
uint32_t marchAgainNative(ExpandEnv env, const ItemQueues& queues, uint32_t most, Crew& crew, GrowthWatch* watch);
void finishAgainNative(ExpandEnv env, Crew& crew);

// What is drawn, and has gaps.
struct GapClosing {
    Node* nodes = nullptr;
    Leaf* leaves = nullptr;
    Chunk* chunks = nullptr;
    uint32_t *firstLeaves = nullptr, *nextLeaves = nullptr;  // as GrowStatus's; null: leaves aren't chained
    uint32_t *nodesWent = nullptr, *leavesWent = nullptr;    // out: GrowthMove::nodes, ::leaves
    uint32_t chunkCount = 0;
    uint32_t nodeCount = 0, leafCount = 0;  // in: with the gaps; out: without
};
// In place: nodes move up in their order, leaves from the end come into the gaps. None goes to a higher number.
void closeGapsNative(GapClosing& closing, Crew& crew);

}  // namespace espalier
