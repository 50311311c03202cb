// Expansion on the GPU (Buron 2015 §5, §7). In: seeds, rule maps, layers and surfaces by address. Out: nodes,
// chunks, branches and leaves. Waves of a queue are recorded ahead as indirect dispatches, which cost nothing when
// they turn out empty; the terminal passes follow in the same submission. What ran out of room is grown again with
// more, into a second set of buffers, so that the last good growth stands until the new one is complete.
#include <algorithm>

#include "runtime/core/undo.hpp"
#include "runtime/expand/growth.hpp"

namespace espalier {
namespace {

constexpr uint32_t kMostAttempts = 48;

// What growth begins with, the frozen plants being there already.
GrowStatus withFrozen(GrowStatus status, const FrozenSum& frozen) {
    const GrowthRecords& r = frozen.records;
    status.chunks = status.frozenChunks = status.waveChunks = uint32_t(r.chunks.size());
    status.chunkGroups[0] = groupsOf(status.chunks, 1);
    status.nodes = status.frozenNodes = uint32_t(r.nodes.size());
    status.branches = status.frozenBranches = uint32_t(r.branches.size());
    status.leaves = uint32_t(r.leaves.size());
    status.chunkCapacity += status.chunks;
    status.nodeCapacity += status.nodes;
    status.branchCapacity += status.branches;
    status.leafCapacity = std::min(status.leafCapacity + status.leaves, status.mostLeaves);
    status.steps = frozen.steps;
    status.inserted = frozen.inserted;
    status.stopped = frozen.stopped;
    status.deadEnds = frozen.deadEnds;
    status.hash[0] = frozen.hash[0];
    status.hash[1] = frozen.hash[1];
    return status;
}
// An attempt's counters without them.
GrowStatus withoutFrozen(GrowStatus status, const GrowthRecords& frozen) {
    status.chunks -= uint32_t(frozen.chunks.size());
    status.nodes -= uint32_t(frozen.nodes.size());
    status.branches -= uint32_t(frozen.branches.size());
    status.leaves -= uint32_t(frozen.leaves.size());
    return status;
}

}  // namespace

Status Growth::uploadInputs(Commands& commands, const GrowthInputs& inputs, const FrozenSum& frozen,
                            const GrowthCut& cut) {
    const Plants& plants = plants_.spare();
    const Links& links = links_.spare();
    const GrowthRecords& r = frozen.records;
    if (Status s = allDone({commands.upload(plants.nodes, r.nodes), commands.upload(plants.leaves, r.leaves),
                            commands.upload(links.chunks, r.chunks), commands.upload(links.branches, r.branches)});
        !s)
        return s;
    const std::vector<Wave> waves = wavesOfSeeds(uint32_t(inputs.seeds.size()), inputs.limits, room_);
    if (densityWords(inputs.limits, 0) > 1) commands.fill(density_, 0);
    if (reachOf(inputs) > 0) commands.fill(avoidHeads_, kNoIndex);
    return allDone({uploadStatus(commands, inputs, withFrozen(freshStatus(inputs, room_, cut), frozen)),
                    commands.upload(waves_, waves), commands.upload(items_[0], itemsOfSeeds(inputs.seeds)),
                    uploadTables(commands, inputs)});
}

Result<Growth::Outcome> Growth::attempt(const GrowthInputs& inputs, const FrozenSum& frozen, const GrowthCut& cut) {
    if (Status room = makeRoom(inputs, frozen.records); !room) return room.failure();
    ExpandEnv env = environment(inputs, plants_.spare(), links_.spare());
    env.phase = lastWave(cut);
    const auto add = [&](Run& run, uint32_t first, uint32_t last) -> Status {
        if (first == 0) {
            if (Status sent = uploadInputs(run.send(), inputs, frozen, cut); !sent) return sent;
            if (Status packed = run.add(tableStages(shaders(), env, uint32_t(inputs.grammars.size()))); !packed)
                return packed;
        }
        readBack(run, last);
        return run.add(growthStages(shaders(), env, itemQueues(), inputs.limits, reachOf(inputs) > 0 ? room_.rounds : 0,
                                    first, last),
                       inputs.watch);
    };
    Outcome outcome;
    const auto waitsStill = [&](const Run& run, uint32_t last) -> Result<bool> {
        take(run, last, outcome);
        const GrowStatus& s = outcome.status;
        if (outcome.waves.back().count == 0 || s.items > room_.items || s.chunks > s.chunkCapacity) return false;
        if (!goesOn(inputs.watch, s.nodes)) return stoppedFailure();
        return true;
    };
    Status grown =
        runWaves(runner_, "expand", atOnce(inputs), likelyWaves_, inputs.limits.maxDepth + 1, add, waitsStill);
    if (!grown) return grown.failure();
    return outcome;
}

void Growth::publish(const GrowthInputs& inputs, const FrozenSum& frozen, const Outcome& outcome, Origin&& origin) {
    origin_ = std::move(origin);
    plants_.swap();
    links_.swap();
    tablesStand_ = true;
    chained_ = frozen.records.nodes.empty();
    show(outcome.status, true);
    stats_.seeds = uint32_t(inputs.seeds.size() + inputs.frozen.size());
    takeCounters(outcome.status, stats_);
    stats_.derived = stats_.nodes - uint32_t(frozen.records.nodes.size());
    stats_.waves = wavesOf(outcome.waves);
    likelyWaves_ = stats_.waves + 2;
    widest_ = widestOf(outcome.waves);
    stats_.marchMs = outcome.marchMs;
    stats_.terminalsMs = outcome.terminalsMs;
    stats_.fitMs = outcome.fitMs;
    stats_.expandMs = outcome.marchMs + outcome.terminalsMs + outcome.fitMs;
    stats_.reservedBytes = reserved();
}

Status Growth::grow(const GrowthInputs& inputs) {
    if (inputs.watch) inputs.watch->begin();
    Status usable = checkInputs(inputs);
    if (!usable) return usable;
    stats_.dispatches = 0;
    if (canRegrow(inputs)) {
        const bool closes = !gappyLinks() && gappy(inputs);
        if (closes)
            if (Status closed = compact(inputs); !closed) return closed;
        Result<Regrown> done = regrowWithFrozen(inputs);
        if (done && *done == Regrown::noRoom) {
            const Status closed = closes && atOnce(inputs) ? enlarge() : compact(inputs);
            if (!closed) return closed;
            done = regrowWithFrozen(inputs);
        }
        if (!done) return done.failure();
        if (*done == Regrown::done) return Done{};
    }
    return growAll(inputs);
}

// What has failed leaves the room that it asked for to nobody: later growth may need far less.
Status Growth::growAll(const GrowthInputs& inputs) {
    Undo room([this, before = room_] { room_ = before; });
    Status grown = growWhole(inputs);
    if (grown) room.done();
    return grown;
}

Status Growth::growWhole(const GrowthInputs& inputs) {
    room_.items = std::max(room_.items, uint32_t(inputs.seeds.size()));
    const FrozenSum frozen = sumOf(inputs.frozen, uint32_t(inputs.seeds.size()));
    if (frozen.records.leaves.size() > inputs.limits.maxLeaves)
        return limitFailure(Verdict::tooManyLeaves, inputs.limits);
    const bool fits = frozen.records.nodes.size() < inputs.limits.maxNodes || inputs.seeds.empty();
    const GrowthLimits limits = limitsBeside(inputs.frozen, inputs.limits);
    GrowthCut cut = noCut(inputs.limits);
    Verdict verdict = Verdict::impossible;
    uint32_t overflow = 0, enlarged = 0;
    for (uint32_t i = 0; fits && i < kMostAttempts; ++i) {
        Result<Outcome> outcome = attempt(inputs, frozen, cut);
        if (!outcome) return outcome.failure();
        verdict = judge(withoutFrozen(outcome->status, frozen.records), outcome->waves, limits, room_, cut);
        if (verdict == Verdict::impossible || verdict == Verdict::tooManyLeaves) break;
        if (verdict == Verdict::complete) {
            if (!everyShapeGrew(withoutFrozen(outcome->status, frozen.records), outcome->waves))
                return device_.fault("growth lost shapes that it had queued");
            publish(inputs, frozen, *outcome, originOf(inputs));
            const GrowthCut none = noCut(inputs.limits);
            whole_ = cut.wave == none.wave && cut.key == none.key;
            stats_.overflow = overflow;
            stats_.enlarged = enlarged;
            stats_.expansions += 1;
            return Done{};
        }
        (verdict == Verdict::cut ? overflow : enlarged) += 1;
    }
    return limitFailure(verdict, inputs.limits);
}

}  // namespace espalier
