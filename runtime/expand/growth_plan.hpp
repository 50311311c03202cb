#pragma once

// What GPU and CPU growth share on the host: checked inputs, the first wave, and the answer to running out of room.

#include <vector>

#include "runtime/expand/growth_data.hpp"
#include "runtime/machine/waves.hpp"
#include "shaders/shared/expand_env.h"
#include "shaders/shared/expand_rows.h"

namespace espalier {

// Names the first seed or limit that can't be used.
Status checkInputs(const GrowthInputs& inputs);

std::vector<WorkItem> itemsOfSeeds(std::span<const Seed> seeds);

// Where each grammar has its packed tables, and how many words all take with these at their head.
std::vector<GrammarTables> placeTables(const GrowthInputs& inputs, uint64_t& words);

// Where growth is cut, so that it stays within its limits: see refused() in expand_grow.h.
struct GrowthCut {
    uint32_t wave = 0;
    uint64_t key = 0;  // 2^32: the whole wave is grown
};
GrowthCut noCut(const GrowthLimits& limits);

// The largest distance that stems keep; 0: none does.
float reachOf(const GrowthInputs& inputs);
// Cells of the grid that `room` has places for; a power of two.
uint32_t avoidCells(const GrowthRoom& room);

// Status and waves at the start of an attempt.
GrowStatus freshStatus(const GrowthInputs& inputs, const GrowthRoom& room, const GrowthCut& cut);
uint32_t lastWave(const GrowthCut& cut);  // ExpandEnv::phase of the march
std::vector<Wave> wavesOfSeeds(uint32_t seeds, const GrowthLimits& limits, const GrowthRoom& room);

enum class Verdict { complete, tooSmall, cut, impossible, tooManyLeaves };
// Judges an attempt. waves: those that ran and the next. tooSmall: `room` was and has been enlarged; cut: a limit was
// exceeded and `cut` has been moved. impossible: limits leave room for nothing. tooManyLeaves: they can't be cut.
Verdict judge(const GrowStatus& status, std::span<const Wave> waves, const GrowthLimits& limits, GrowthRoom& room,
              GrowthCut& cut);

// Whether each shape that was queued became a chunk, or was dropped behind what came too near to others, and each
// chunk's nodes were counted, in every wave that no limit cuts. It holds of every complete growth, whatever the
// grammar: where it doesn't, the device doesn't run the kernels as they are written. waves: of a complete attempt
// without frozen plants.
bool everyShapeGrew(const GrowStatus& status, std::span<const Wave> waves);

// Why limits let nothing grow; verdict: one of the last two.
Failure limitFailure(Verdict verdict, const GrowthLimits& limits);
bool stopped(const GrowthInputs& inputs);  // by who watches

// Takes out what edits have left as gaps and renumbers the rest.
void compactRecords(GrowthRecords& records);

// What the limits leave to that which grows beside frozen plants.
GrowthLimits limitsBeside(std::span<const FrozenPlant> frozen, GrowthLimits limits);
// Chunks at most.
uint32_t chunkLimit(const GrowthLimits& limits);

// Spans and bytes, from the other counts.
void countBytes(GrowthStats& stats);
// The figures that come from counters.
void takeCounters(const GrowStatus& status, GrowthStats& stats);

}  // namespace espalier
