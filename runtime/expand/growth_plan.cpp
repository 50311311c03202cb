// Host side of expansion that GPU and CPU share. Seeds become the first wave's items. After an attempt the counters
// tell whether room or a limit was exceeded; the answer is more room, or a cut after whole waves that is the same in
// every run, since what a wave grows doesn't depend on the schedule.
#include "runtime/expand/growth_plan.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <string>

#include "shaders/shared/expand_grow.h"

namespace espalier {
namespace {

constexpr uint64_t kWholeWave = 1ull << 32;
constexpr uint32_t kMostAvoid = 1u << 28, kMostRounds = 64;
constexpr size_t kMostGrammars = 1u << 16;  // as an item's symbol holds them

bool finite(const Seed& seed) {
    const Walk& w = seed.walk;
    bool ok = std::isfinite(w.uv.x) && std::isfinite(w.uv.y) && std::isfinite(w.arc);
    ok = ok && std::isfinite(w.direction.x) && std::isfinite(w.direction.y) && std::isfinite(w.direction.z);
    for (float arg : seed.args) ok = ok && std::isfinite(arg);
    return ok;
}

// Room for `need` and half as much for edits, at most `limit`. Counts that were cut short themselves are doubled.
uint32_t enlarged(uint32_t have, uint32_t need, bool exact, uint32_t limit) {
    if (need <= have && exact) return have;
    uint64_t wanted = exact ? need + need / 2ull + 64 : std::max<uint64_t>(need * 2ull, have * 2ull);
    return uint32_t(std::clamp<uint64_t>(wanted, have, std::max(limit, have)));
}

// The first wave that exceeds a limit, and the share of it that may stay. cut: in force while these waves grew.
GrowthCut findCut(std::span<const Wave> waves, const GrowthLimits& limits, const GrowthCut& cut) {
    auto shareOf = [&](size_t wave, double share) -> GrowthCut {
        double present = double(wave == cut.wave ? cut.key : kWholeWave);
        return {uint32_t(wave), uint64_t(0.97 * share * present)};
    };
    uint64_t nodes = 0, chunks = 0;
    uint64_t most = chunkLimit(limits);
    for (size_t w = 0; w < waves.size(); ++w) {
        if (w > 0 && waves[w].count > most) return shareOf(w - 1, double(most) / double(waves[w].count));
        // Nodes of chunks that found no room aren't counted, so chunks come first.
        if (chunks + waves[w].chunks > most) return shareOf(w, double(most - chunks) / waves[w].chunks);
        if (nodes + waves[w].nodes > limits.maxNodes)
            return shareOf(w, double(limits.maxNodes - nodes) / waves[w].nodes);
        nodes += waves[w].nodes;
        chunks += waves[w].chunks;
    }
    return {~0u, kWholeWave};
}

}  // namespace

uint32_t chunkLimit(const GrowthLimits& limits) {
    return std::max(limits.maxNodes / 2, 4096u);
}

GrowthLimits limitsBeside(std::span<const FrozenPlant> frozen, GrowthLimits limits) {
    for (const FrozenPlant& plant : frozen) {
        limits.maxNodes -= std::min(limits.maxNodes - 1, uint32_t(plant.records->nodes.size()));
        limits.maxLeaves -= std::min(limits.maxLeaves, uint32_t(plant.records->leaves.size()));
    }
    return limits;
}

Status checkInputs(const GrowthInputs& inputs) {
    if (inputs.limits.maxDepth < 1 || inputs.limits.maxDepth > 65534)
        return Failure("growth", "maxDepth must be 1 to 65534, not " + std::to_string(inputs.limits.maxDepth));
    if (uint32_t(inputs.limits.walk) > 1 || uint32_t(inputs.limits.tangents) > 1)
        return Failure("growth", "there are two walks and two kinds of tangents");
    if (inputs.limits.maxNodes < 1) return Failure("growth", "maxNodes must be at least 1");
    if (inputs.limits.maxLeaves > 1u << 31) return Failure("growth", "maxLeaves must be at most 2^31");
    if (!(inputs.limits.leafDensityCap >= 0) || !std::isfinite(inputs.limits.leafDensityCap))
        return Failure("growth", "the density cap must be a finite number of leaves, 0 or more");
    if (inputs.grammars.size() > kMostGrammars)
        return Failure("growth", "there are " + std::to_string(inputs.grammars.size()) +
                                     " grammars, each counted once more for every set of values of seeds' own; " +
                                     std::to_string(kMostGrammars) + " are the most");
    if (!inputs.widths.empty() && inputs.widths.size() != inputs.grammars.size())
        return Failure("growth", std::to_string(inputs.widths.size()) + " widths for " +
                                     std::to_string(inputs.grammars.size()) + " grammars");
    if (!inputs.avoid.empty() && inputs.avoid.size() != inputs.grammars.size())
        return Failure("growth", std::to_string(inputs.avoid.size()) + " distances for " +
                                     std::to_string(inputs.grammars.size()) + " grammars");
    for (float distance : inputs.avoid)
        if (!(distance >= 0) || !std::isfinite(distance))
            return Failure("growth", "a distance that stems keep must be a finite number of metres, 0 or more");
    for (size_t i = 1; i < inputs.pruned.size(); ++i)
        if (inputs.pruned[i - 1] >= inputs.pruned[i]) return Failure("growth", "keys of pruned branches must ascend");
    for (size_t i = 0; i < inputs.seeds.size(); ++i) {
        const Seed& seed = inputs.seeds[i];
        std::string name = "seed " + std::to_string(i);
        if (seed.grammar >= inputs.grammars.size())
            return Failure("growth", name + " names grammar " + std::to_string(seed.grammar) + " of " +
                                         std::to_string(inputs.grammars.size()));
        if (seed.symbol >= inputs.grammars[seed.grammar].symbolCount)
            return Failure("growth",
                           name + " names symbol " + std::to_string(seed.symbol) + ", which its grammar lacks");
        if ((seed.walk.place >> 16) >= inputs.surfaceCount)
            return Failure("growth", name + " stands on surface " + std::to_string(seed.walk.place >> 16) + " of " +
                                         std::to_string(inputs.surfaceCount));
        if (!finite(seed)) return Failure("growth", name + " has numbers that aren't finite");
    }
    return Done{};
}

std::vector<WorkItem> itemsOfSeeds(std::span<const Seed> seeds) {
    std::vector<WorkItem> items(seeds.size());
    for (size_t i = 0; i < seeds.size(); ++i) {
        const Seed& seed = seeds[i];
        WorkItem& item = items[i];
        item.key = seed.key;
        item.walk = seed.walk;
        item.symbol = (seed.grammar << 16) | seed.symbol;
        std::copy(seed.args, seed.args + 4, item.args);
        item.parent = item.origin = item.branch = kNoIndex;
        item.seed = uint32_t(i);
        item.depth = 0;
        item.step = 0;
    }
    return items;
}

std::vector<GrammarTables> placeTables(const GrowthInputs& inputs, uint64_t& words) {
    std::vector<GrammarTables> tables(inputs.grammars.size());
    words = tables.size() * kGrammarTables_words;
    auto take = [&](uint64_t count) {
        uint64_t first = words;
        words += count;
        return uint32_t(first);
    };
    for (size_t i = 0; i < tables.size(); ++i) {
        const RuleMapRef& map = inputs.grammars[i];
        GrammarTables& t = tables[i];
        t = {};
        t.symbols = take(uint64_t(map.symbolCount) * kSymbolRow_words);
        t.rules = take(uint64_t(map.ruleCount) * kRuleRow_words);
        t.successors = take(uint64_t(map.successorCount) * kSuccessorRow_words);
        t.terminals = take(uint64_t(map.terminalCount) * kTerminalRow_words);
        t.extrudes = take(uint64_t(map.extrudeCount) * kExtrudeRow_words);
        t.code = take(uint64_t(map.codeCount) * 2);
        t.sites = take(map.siteCount);
        t.width = inputs.widths.empty() ? 0.0f : inputs.widths[i];
        t.avoid = inputs.avoid.empty() ? 0.0f : inputs.avoid[i];
    }
    return tables;
}

GrowthCut noCut(const GrowthLimits& limits) {
    return {limits.maxDepth, 0};
}

float reachOf(const GrowthInputs& inputs) {
    return inputs.avoid.empty() ? 0 : *std::ranges::max_element(inputs.avoid);
}

uint32_t avoidCells(const GrowthRoom& room) {
    return std::bit_ceil(std::clamp(room.avoid / 2, 1024u, 1u << 24));
}

GrowStatus freshStatus(const GrowthInputs& inputs, const GrowthRoom& room, const GrowthCut& cut) {
    const GrowthLimits& limits = inputs.limits;
    GrowStatus s{};
    s.chunkCapacity = room.chunks;
    s.nodeCapacity = room.nodes;
    s.branchCapacity = room.branches;
    s.leafCapacity = std::min(room.leaves, limits.maxLeaves);
    s.mostLeaves = limits.maxLeaves;
    s.nodeGroups[1] = s.nodeGroups[2] = 1;
    s.branchGroups[1] = s.branchGroups[2] = 1;
    // A share of one is the same as cutting before the next wave.
    s.limitWave = cut.key >= kWholeWave ? cut.wave + 1 : cut.wave;
    s.limitKey = cut.key >= kWholeWave ? 0 : uint32_t(cut.key);
    s.walkMode = uint32_t(limits.walk);
    s.tangentMode = uint32_t(limits.tangents);
    s.leafDensityCap = limits.leafDensityCap;
    s.avoidReach = reachOf(inputs);
    s.gridReach = std::max(s.avoidReach, room.grid);
    s.avoidCells = avoidCells(room);
    s.avoidCapacity = room.avoid;
    s.chunkGroups[1] = s.chunkGroups[2] = 1;
    return s;
}

uint32_t lastWave(const GrowthCut& cut) {
    return cut.key > 0 || cut.wave == 0 ? cut.wave : cut.wave - 1;
}

std::vector<Wave> wavesOfSeeds(uint32_t seeds, const GrowthLimits& limits, const GrowthRoom& room) {
    const uint32_t items = std::min(seeds, room.items);
    return wavesBefore(limits.maxDepth + 2ull, items, laneGroupsOf(items, kItemsPerGroup));
}

Verdict judge(const GrowStatus& status, std::span<const Wave> waves, const GrowthLimits& limits, GrowthRoom& room,
              GrowthCut& cut) {
    const uint32_t most = chunkLimit(limits);
    const bool itemsFit = status.items <= room.items, chunksFit = status.chunks <= room.chunks;
    // Who found no room left nothing to the waves after it, and who that was hangs on the schedule: such counts tell of
    // a cut only where there can't be more room.
    const bool counted = (itemsFit || room.items >= most) && (chunksFit || room.chunks >= most);
    if (counted) {
        GrowthCut needed = findCut(waves, limits, cut);
        bool later = needed.wave > cut.wave || (needed.wave == cut.wave && needed.key >= cut.key);
        if (!later) {
            if (cut.wave == 0 && cut.key == 0) return Verdict::impossible;
            cut = needed;
            return Verdict::cut;
        }
    }
    const bool counts = itemsFit && chunksFit;
    const bool gridFits = status.avoidTaken <= room.avoid && status.gridNeed == 0;
    const bool complete = counts && gridFits && status.waveUndecided == 0;
    if (complete && status.leaves > limits.maxLeaves) return Verdict::tooManyLeaves;
    bool fits =
        complete && status.nodes <= room.nodes && status.branches <= room.branches && status.leaves <= room.leaves;
    if (fits) return Verdict::complete;
    const bool nodesFit = status.nodes <= room.nodes && status.branches <= room.branches;
    const bool terminalsRan = complete && nodesFit;
    // Where stems keep distances an attempt ends with the wave that has found no room: more of them would have come.
    const bool early = status.avoidReach > 0 && !(nodesFit && gridFits);
    if (counts && nodesFit && gridFits && status.waveUndecided > 0)
        room.rounds = std::min(room.rounds * 2, kMostRounds);
    room.grid = std::max(room.grid, 1.5f * std::bit_cast<float>(status.gridNeed));
    room.items = enlarged(room.items, std::max(status.items, room.items), itemsFit, most);
    room.chunks = enlarged(room.chunks, status.chunks, counts, most);
    room.nodes = enlarged(room.nodes, status.nodes, counts && !(early && status.nodes > room.nodes), limits.maxNodes);
    room.branches =
        enlarged(room.branches, status.branches, counts && !(early && status.branches > room.branches), most);
    room.avoid = enlarged(room.avoid, status.avoidTaken, status.avoidTaken <= room.avoid, kMostAvoid);
    // Leaves are counted only when all else fitted.
    room.leaves = enlarged(room.leaves, status.leaves, terminalsRan || status.leaves == 0, limits.maxLeaves);
    return Verdict::tooSmall;
}

bool everyShapeGrew(const GrowStatus& status, std::span<const Wave> waves) {
    const bool drops = status.avoidReach > 0;
    uint64_t chunks = 0, nodes = 0, missing = 0;
    for (size_t w = 0; w < waves.size(); ++w) {
        if (w < status.limitWave) {
            if (waves[w].chunks > waves[w].count || (!drops && waves[w].chunks < waves[w].count)) return false;
            missing += waves[w].count - waves[w].chunks;
        }
        chunks += waves[w].chunks;
        nodes += waves[w].nodes;
    }
    // Of the waves that a limit cuts nobody knows what was dropped and what was refused.
    const bool cut = status.limitWave < waves.size();
    const bool droppedAll = cut ? missing <= status.dropped : missing == status.dropped;
    return droppedAll && status.waveUndecided == 0 && chunks == status.chunks && nodes == status.nodes;
}

Failure limitFailure(Verdict verdict, const GrowthLimits& limits) {
    if (verdict == Verdict::tooManyLeaves)
        return Failure("growth", "the plants would have more than " + std::to_string(limits.maxLeaves) + " leaves");
    return Failure("growth", "the limit of " + std::to_string(limits.maxNodes) + " nodes leaves room for nothing");
}

bool stopped(const GrowthInputs& inputs) {
    return inputs.watch && inputs.watch->stopped();
}

void countBytes(GrowthStats& stats) {
    stats.nodeBytes = uint64_t(stats.nodes) * sizeof(Node);
    // With the links to leaves, GrowStatus::firstLeaves and nextLeaves.
    constexpr uint64_t kLink = sizeof(uint32_t);
    stats.leafBytes = stats.leaves * (sizeof(Leaf) + kLink) + (stats.leaves > 0 ? stats.nodes * kLink : 0);
    stats.chunkBytes = uint64_t(stats.chunks) * sizeof(Chunk) + uint64_t(stats.branches) * sizeof(BranchRecord);
}

void takeCounters(const GrowStatus& status, GrowthStats& stats) {
    stats.chunks = status.chunks - status.cutChunks;
    stats.branches = status.branches - status.cutBranches;
    stats.nodes = status.nodes - status.cutNodes;
    stats.leaves = status.leaves;
    stats.steps = status.steps;
    stats.inserted = status.inserted;
    stats.stopped = status.stopped;
    stats.deadEnds = status.deadEnds;
    countBytes(stats);
    uint32_t low = 0, high = 0;
    for (uint32_t i = 0; i < kHashSlots; ++i) {
        low += status.hash[2 * i];
        high += status.hash[2 * i + 1];
    }
    stats.hash = uint64_t(high) << 32 | low;
}

}  // namespace espalier
