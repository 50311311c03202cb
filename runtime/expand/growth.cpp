// Expansion on the GPU (Buron 2015 §5, §7). In: seeds, rule maps, layers and surfaces by address. Out: nodes,
// chunks, branches and leaves. Waves of a queue are recorded ahead as indirect dispatches, which cost nothing when
// they turn out empty; the terminal passes follow in the same submission. What ran out of room is grown again with
// more, into a second set of buffers, so that the last good growth stands until the new one is complete.
#include <algorithm>
#include <cstddef>

#include "runtime/core/check.hpp"
#include "runtime/core/undo.hpp"
#include "runtime/expand/growth.hpp"

namespace espalier {
namespace {

constexpr uint32_t kMostAttempts = 48;

// What growth begins with, the frozen plants being there already.
GrowStatus withFrozen(GrowStatus status, const FrozenSum& frozen) {
    const GrowthRecords& r = frozen.records;
    status.chunks = uint32_t(r.chunks.size());
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
    std::vector<Wave> wave(inputs.limits.maxDepth + 2u, Wave{0, {0, 1, 1}, 0, 0, 0, 0});
    wave[0] = firstWave(uint32_t(inputs.seeds.size()), room_);
    return allDone({uploadStatus(commands, inputs, withFrozen(freshStatus(inputs.limits, room_, cut), frozen)),
                    commands.upload(waves_, wave), commands.upload(items_[0], itemsOfSeeds(inputs.seeds)),
                    uploadTables(commands, inputs, !runsNative(inputs))});
}

void Growth::recordWaves(Pass& pass, const Program& march, const ExpandEnv& base, uint32_t first, uint32_t last) {
    ExpandEnv env = base;
    const uint32_t rounds = (room_.items + kDispatchItems - 1) / kDispatchItems;
    stats_.dispatches += (last - first) * rounds;
    for (uint32_t w = first; w < last; ++w) {
        env.wave = w;
        env.items = addressOf<WorkItemBuf>(items_[w & 1]);
        env.nextItems = addressOf<WorkItemBuf>(items_[(w + 1) & 1]);
        const uint64_t groups = w * sizeof(Wave) + offsetof(Wave, groups);
        for (uint32_t r = 0; r < rounds; ++r) {
            pass.dispatchIndirect(march, waves_, groups, env, {uniformTables(), lanes_});
            pass.barrier(Use::compute | Use::indirect, Use::compute | Use::indirect);
        }
    }
}

// Waves [first, last), then the terminal passes, which do nothing should wave `last` not be empty.
Status Growth::record(Commands& commands, const ExpandEnv& base, uint32_t first, uint32_t last,
                      const GrowthLimits& limits) {
    {
        Pass pass(commands, "expand march");
        recordWaves(pass, kernel(marchOf(limits)), base, first, last);
    }
    ExpandEnv env = base;
    env.wave = last;
    recordTerminals(commands, env, limits);
    commands.copy(status_, readback_, sizeof(GrowStatus));
    commands.copy(waves_, readback_, (last + 1) * sizeof(Wave), 0, sizeof(GrowStatus));
    commands.barrier(Use::transfer, Use::host);
    return Done{};
}

void Growth::recordTerminals(Commands& commands, ExpandEnv env, const GrowthLimits& limits) {
    const Program& terminals = kernel(GrowthKernel::terminals);
    env.phase = kTerminalsWrite;
    constexpr uint64_t kNodes = offsetof(GrowStatus, nodeGroups), kBranches = offsetof(GrowStatus, branchGroups);
    bool capped = limits.leafDensityCap > 0, joined = limits.tangents == TangentMode::paper;
    stats_.dispatches += 3 + (joined ? 1 : 0) + (capped ? 1 : 0);
    if (capped || joined) {
        commands.fill(density_, 0);
        commands.barrier(Use::transfer, Use::compute);
    }
    {
        Pass pass(commands, "expand terminals");
        if (joined) {
            env.phase = kTerminalsJoints;
            pass.dispatchIndirect(kernel(GrowthKernel::branches), status_, kBranches, env);
            pass.barrier(Use::compute, Use::compute);
        }
        if (capped) {
            env.phase = kTerminalsCount;
            pass.dispatchIndirect(terminals, status_, kNodes, env, {uniformTables(), lanes_});
            pass.barrier(Use::compute, Use::compute);
        }
        env.phase = kTerminalsWrite;
        pass.dispatchIndirect(terminals, status_, kNodes, env, {uniformTables(), lanes_});
        pass.barrier(Use::compute, Use::compute);
    }
    Pass pass(commands, "expand fit");
    pass.dispatchIndirect(kernel(GrowthKernel::branches), status_, kBranches, env);
    pass.barrier(Use::compute, Use::compute);
    pass.dispatchIndirect(kernel(GrowthKernel::fit), status_, kNodes, env);
    pass.barrier(Use::compute, Use::transfer | Use::compute | Use::indirect);
}

// What follows needs no kernels, so none are made.
Result<Growth::Outcome> Growth::attemptNative(const GrowthInputs& inputs, const FrozenSum& frozen,
                                              const GrowthCut& cut) {
    ExpandEnv env = environment(inputs, plants_.spare(), links_.spare());
    {
        Result<Commands> commands = Commands::begin(device_, "expand inputs");
        if (!commands) return commands.failure();
        if (Status uploaded = uploadInputs(*commands, inputs, frozen, cut); !uploaded) return uploaded.failure();
        if (densityWords(inputs.limits, 0) > 1) commands->fill(density_, 0);
        if (Status finished = commands->finish(); !finished) return finished.failure();
    }
    packTablesNative(env, uint32_t(inputs.grammars.size()));
    Outcome outcome;
    env.phase = lastWave(cut);
    outcome.marchMs = millisecondsOf(
        [&] { env.wave = marchNative(env, itemQueues(), inputs.limits.maxDepth + 1, crew_, true, inputs.watch); });
    if (stopped(inputs)) return stoppedFailure();
    outcome.terminalsMs = millisecondsOf([&] { terminalsNative(env, crew_, inputs.watch); });
    if (stopped(inputs)) return stoppedFailure();
    outcome.fitMs = millisecondsOf([&] { fitNative(env, crew_); });
    outcome.status = status_.mappedAs<GrowStatus>()[0];
    outcome.waves.assign(env.waves.v, env.waves.v + env.wave + 1);
    return outcome;
}

Result<Growth::Outcome> Growth::attempt(const GrowthInputs& inputs, const FrozenSum& frozen, const GrowthCut& cut) {
    if (Status room = makeRoom(inputs, frozen.records); !room) return room.failure();
    stats_.native = runsNative(inputs);
    return stats_.native ? attemptNative(inputs, frozen, cut) : attemptShaders(inputs, frozen, cut);
}

Result<Growth::Outcome> Growth::attemptShaders(const GrowthInputs& inputs, const FrozenSum& frozen,
                                               const GrowthCut& cut) {
    ExpandEnv env = environment(inputs, plants_.spare(), links_.spare());
    Outcome outcome;
    uint32_t first = 0;
    uint32_t most = inputs.limits.maxDepth + 1;
    uint32_t batch = std::min(likelyWaves_, most);
    while (true) {
        uint32_t last = std::min(first + batch, most);
        Result<Commands> commands = Commands::begin(device_, "expand");
        if (!commands) return commands.failure();
        if (first == 0) {
            Status uploaded = uploadInputs(*commands, inputs, frozen, cut);
            if (!uploaded) return uploaded.failure();
        }
        env.phase = lastWave(cut);
        Status recorded = record(*commands, env, first, last, inputs.limits);
        if (!recorded) return recorded.failure();
        Status finished = commands->finish();
        if (!finished) return finished.failure();
        device_.collect();
        outcome.marchMs += device_.milliseconds("expand march");
        outcome.terminalsMs += device_.milliseconds("expand terminals");
        outcome.fitMs += device_.milliseconds("expand fit");
        Outcome read = readOutcome(last);
        outcome.status = read.status;
        outcome.waves = std::move(read.waves);
        bool outOfRoom = outcome.status.items > room_.items || outcome.status.chunks > outcome.status.chunkCapacity;
        if (outcome.waves[last].count == 0 || last == most || outOfRoom) return outcome;
        if (!goesOn(inputs.watch, outcome.status.nodes)) return stoppedFailure();
        first = last;
        batch = batch * 2;
    }
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
    auto empty = std::find_if(outcome.waves.begin(), outcome.waves.end(), [](const Wave& w) { return w.count == 0; });
    stats_.waves = uint32_t(empty - outcome.waves.begin());
    likelyWaves_ = stats_.waves + 2;
    widest_ = 0;
    for (const Wave& wave : outcome.waves) widest_ = std::max(widest_, wave.count);
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
            const Status closed = closes && runsNative(inputs) ? enlarge() : compact(inputs);
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
