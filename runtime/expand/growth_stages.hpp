#pragma once

// The stages of growth, as lists: which kernels run in which order, over what, and what each of them reads and writes.

#include "runtime/expand/growth_data.hpp"
#include "runtime/run/stage.hpp"
#include "shaders/expand/compact.h"
#include "shaders/shared/expand_env.h"

namespace espalier {

// What shaders ask for beside ExpandEnv; as it is, nothing: of a list for native code alone.
struct GrowthShaders {
    const Buffer *waves = nullptr, *status = nullptr;  // ExpandEnv's: they hold numbers of groups
    const Buffer* tables = nullptr;                    // bound as the packed tables
    bool tablesByAddress = false;                      // they are read by address instead
    uint32_t features = 0;                             // kFeature...: what grammars use
    uint64_t laneBytes = 0;                            // of marches and of passes over nodes
    uint32_t groups = 1;                               // of passes that go through chunks or lists by themselves
};

using ItemQueues = std::array<WorkItemBuf, 2>;  // wave w is in [w & 1]

// Packs the tables of `grammars` rule maps.
StageList tableStages(const GrowthShaders& shaders, const ExpandEnv& env, uint32_t grammars);
// Grows waves [first, last), env.phase being the last that may be grown, then terminals, fit and the structure's hash,
// which do nothing should wave `last` not be empty. avoidRounds: GrowthRoom::rounds, 0: no stems keep a
// distance.
StageList growthStages(const GrowthShaders& shaders, ExpandEnv env, const ItemQueues& queues,
                       const GrowthLimits& limits, uint32_t avoidRounds, uint32_t first, uint32_t last);
// Of a regrowth: finds the chunks that are to be grown again, and queues them in env.items.
StageList findStages(const GrowthShaders& shaders, const ExpandEnv& env);
// Grows these, as growthStages(), and all that depends on them. What is drawn changes behind the waves only, if what
// was grown is whole and fits: then nothing stops it.
StageList regrowthStages(const GrowthShaders& shaders, ExpandEnv env, const ItemQueues& queues, uint32_t first,
                         uint32_t last);
// Copies nodes and leaves to where there are no gaps between them;
StageList compactionStages(const GrowthShaders& shaders, const CompactEnv& env);
// closes the gaps in place, which only native code can.
StageList closingStages(const CompactEnv& env);

}  // namespace espalier
