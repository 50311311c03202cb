#pragma once

// The stages of patterns, as lists.

#include "runtime/run/stage.hpp"
#include "shaders/shared/pattern_records.h"

namespace espalier {

constexpr uint32_t kPatternWavesAhead = 12;  // of a list: where nothing waits any more they do nothing

// What shaders ask for beside PatternEnv; as it is, nothing: of a list for native code alone.
struct PatternShaders {
    uint64_t env = 0;                // address of the same PatternEnv
    const Buffer* status = nullptr;  // PatternEnv's: it holds numbers of groups
    uint64_t laneBytes = 0;
};

// The next waves: each derives the symbols of the highest priority, places their pieces, and decides which stand.
StageList patternStages(const PatternShaders& shaders, const PatternEnv& env);
// Sums the hash of what stands.
StageList patternHashStages(const PatternShaders& shaders, const PatternEnv& env);

}  // namespace espalier
