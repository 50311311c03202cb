// Growing again what an edit concerns (expand_again.h says how). In: the same inputs as a full growth, notes of what
// changed. Out: the same growth as a full one would give, by the structure's hash. A first submission finds the chunks
// that read what has changed; a second one grows them in waves, as a full growth, makes the terminals that depend on
// them, and publishes, unless limits or room turn out to be exceeded: then it is done again with more room, or all is
// grown anew.
#include <algorithm>
#include <iterator>

#include "runtime/expand/growth.hpp"

namespace espalier {
namespace {

// Beyond this share of chunks to be grown all anew is the better way.
constexpr uint32_t kMostDirtyOf = 2;

bool sameLimits(const GrowthLimits& a, const GrowthLimits& b) {
    return a.walk == b.walk && a.tangents == b.tangents && a.maxNodes == b.maxNodes && a.maxDepth == b.maxDepth &&
           a.maxLeaves == b.maxLeaves && a.leafDensityCap == b.leafDensityCap;
}

}  // namespace

bool Growth::canRegrow(const GrowthInputs& inputs) const {
    if (!inputs.changes || inputs.changes->everything || !whole_ || !sameLimits(inputs.limits, origin_.limits))
        return false;
    // Counts of leaves by cell and directions at joints are sums over the whole plant.
    if (inputs.limits.walk == WalkMode::paper || inputs.limits.tangents == TangentMode::paper) return false;
    if (inputs.limits.leafDensityCap > 0) return false;
    // Where one stem gives way another may go on, anywhere.
    if (origin_.avoids || reachOf(inputs) > 0) return false;
    return inputs.grammars.size() >= origin_.maps.size();
}

// As much as before, unless that is more than twice what is of use.
Growth::AgainBytes Growth::againBytes(const Links& from) const {
    const auto roomOf = [](uint32_t count, uint32_t room, uint32_t capacity) -> uint64_t {
        const uint64_t needed = std::max<uint64_t>(room, count + count / 2ull);
        return needed < capacity / 2 ? needed : std::max(room, capacity);
    };
    const uint64_t chunks = roomOf(view_.chunkCount, room_.chunks, capacityOf<Chunk>(from.chunks));
    const uint64_t branches = roomOf(view_.branchCount, room_.branches, capacityOf<BranchRecord>(from.branches));
    return {chunks * sizeof(Chunk), branches * sizeof(BranchRecord), std::max(chunks, branches) * sizeof(AgainMark),
            chunks * kLists * 4, chunks / 4 * kChunkNodes * (1 + kResultWords) * 4};
}

Status Growth::makeAgainRoom(const GrowthInputs& inputs, uint64_t editWords) {
    const Links& from = links_.drawn();
    Links& to = links_.spare();
    const AgainBytes again = againBytes(from);
    const struct {
        Buffer* buffer;
        const char* name;
        uint64_t bytes;
    } rows[] = {{&to.chunks, "growth chunks", again.chunks},
                {&to.branches, "growth branches", again.branches},
                {&again_, "regrowth", sizeof(AgainState)},
                {&marks_, "regrowth marks", again.marks},
                {&lists_, "regrowth lists", again.lists},
                {&edits_, "regrowth edits", std::max<uint64_t>(editWords * 4, kLeastEditBytes)},
                {&results_, "regrowth results", again.results}};
    if (Status ok = ensureChains(plants_.drawn()); !ok) return ok;
    // Regrowths of the same nodes find the same room: nothing that is noted there gets lost.
    const uint64_t touched = capacityOf<Node>(plants_.drawn().nodes) * 4ull;
    touchedIsNew_ = touchedIsNew_ || !touched_ || touched_.size() < touched;
    if (touchedIsNew_) view_.touched = nullptr;  // until it holds something
    if (Status ok = ensure(touched_, "growth touched nodes", touched); !ok) return ok;
    for (const auto& row : rows)
        if (Status ok = ensure(*row.buffer, row.name, (row.bytes + 7) / 8 * 8); !ok) return ok;
    if (Status tables = makeTables(inputs); !tables) return tables;
    return makeQueues(inputs);
}

// Links, counters, the edit and the seeds that are planted anew as the first wave.
Status Growth::sendEdit(Run& run, const GrowthInputs& inputs, const SeedChanges& seeds,
                        std::span<const uint32_t> edits) {
    const Links& from = links_.drawn();
    const Links& to = links_.spare();
    const Plants& plants = plants_.drawn();
    run.sendToKernels(from.chunks, to.chunks, view_.chunkCount * sizeof(Chunk));
    run.sendToKernels(from.branches, to.branches, view_.branchCount * sizeof(BranchRecord));
    Commands& commands = run.send();
    commands.fill(marks_, 0);
    if (!chained_) commands.fill(firstLeaves_, kNoIndex);
    if (touchedIsNew_) commands.fill(touched_, 0);

    GrowStatus s = freshStatus(inputs, room_, noCut(inputs.limits));
    s.chunks = view_.chunkCount;
    s.nodes = view_.nodeCount;
    s.branches = view_.branchCount;
    s.leaves = view_.leafCount;
    s.chunkCapacity =
        std::min({capacityOf<Chunk>(to.chunks), capacityOf<AgainMark>(marks_), uint32_t(lists_.size() / 4 / kLists)});
    s.nodeCapacity = std::min(capacityOf<Node>(plants.nodes), uint32_t(firstLeaves_.size() / 4));
    s.branchCapacity = std::min(capacityOf<BranchRecord>(to.branches), capacityOf<AgainMark>(marks_));
    s.leafCapacity = std::min({capacityOf<Leaf>(plants.leaves), uint32_t(nextLeaves_.size() / 4), s.mostLeaves});
    s.again = again_.address();

    std::vector<AgainState> state(1);
    AgainState& a = state[0];
    a = {};
    a.chunksBefore = addressOf<ChunkBuf>(from.chunks);
    a.branchesBefore = addressOf<BranchBuf>(from.branches);
    a.marks = addressOf<AgainMarkBuf>(marks_);
    a.lists = addressOf<UintBuf>(lists_);
    a.edits = addressOf<UintBuf>(edits_);
    a.results = addressOf<UintBuf>(results_);
    a.touched = addressOf<UintBuf>(touched_);
    a.number = view_.number + 1;
    a.chainedLeaves = chained_ ? view_.leafCount : 0;
    a.listCapacity = s.chunkCapacity;
    a.resultCapacity = uint32_t(results_.size() / ((1 + kResultWords) * 4));
    a.chunkCount = view_.chunkCount;
    a.nodeCount = view_.nodeCount;
    a.branchCount = view_.branchCount;
    a.leafCount = view_.leafCount;
    a.liveNodes = stats_.nodes;
    a.liveChunks = stats_.chunks;
    a.mostNodes = inputs.limits.maxNodes;
    a.mostChunks = chunkLimit(limitsBeside(inputs.frozen, inputs.limits));
    for (const FrozenPlant& plant : inputs.frozen) a.mostChunks += uint32_t(plant.records->chunks.size());
    a.firstFrozen = uint32_t(inputs.seeds.size());

    std::vector<WorkItem> all = itemsOfSeeds(inputs.seeds), items;
    for (uint32_t index : seeds.planted) items.push_back(all[index]);
    const uint32_t first = uint32_t(items.size());
    std::vector<Wave> waves =
        wavesBefore(inputs.limits.maxDepth + 2ull, first, laneGroupsOf(first, kItemsPerGroupAgain));
    waves[0].announced = first;
    return allDone({uploadStatus(commands, inputs, s), commands.upload(again_, state),
                    commands.upload(edits_, std::as_bytes(edits)), commands.upload(waves_, waves),
                    commands.upload(items_[0], items)});
}

// Packed tables change with parameters, grammars and where their words lie.
bool Growth::tablesStay(const GrowthInputs& inputs) const {
    const std::vector<RuleMapRef>& maps = origin_.maps;
    const std::vector<float>& widths = origin_.widths;
    return tablesStand_ && inputs.changes->uses.empty() && inputs.changes->grammars.empty() &&
           inputs.changes->extrudes.empty() && inputs.grammars.size() == maps.size() &&
           inputs.widths.size() == widths.size() &&
           std::memcmp(inputs.grammars.data(), maps.data(), maps.size() * sizeof(RuleMapRef)) == 0 &&
           std::equal(widths.begin(), widths.end(), inputs.widths.begin());
}

Result<AgainState> Growth::findDirty(const GrowthInputs& inputs, const SeedChanges& seeds,
                                     std::span<const uint32_t> edits, ExpandEnv env) {
    Result<Run> run = Run::begin(runner_, "find what changed", atOnce(inputs));
    if (!run) return run.failure();
    if (Status sent = sendEdit(*run, inputs, seeds, edits); !sent) return sent.failure();
    StageList stages;
    if (!tablesStay(inputs)) {
        if (Status sent = uploadTables(run->send(), inputs); !sent) return sent.failure();
        stages = tableStages(shaders(), env, uint32_t(inputs.grammars.size()));
    }
    env.items = addressOf<WorkItemBuf>(items_[0]);
    std::ranges::move(findStages(shaders(), env), std::back_inserter(stages));
    run->readBack(again_, sizeof(AgainState));
    if (Status added = run->add(std::move(stages)); !added) return added.failure();
    if (Status finished = run->finish(); !finished) return finished.failure();
    stats_.dispatches += run->dispatches();
    return *run->got<AgainState>(0);
}

// Publishes, unless there is too little room or too much to grow.
Result<Growth::Regrown> Growth::growAgain(const GrowthInputs& inputs, const ExpandEnv& env, Outcome& outcome,
                                          AgainState& state) {
    ExpandEnv waves = env;
    waves.phase = lastWave(noCut(inputs.limits));
    const auto add = [&](Run& run, uint32_t first, uint32_t last) -> Status {
        StageList stages = regrowthStages(shaders(), waves, itemQueues(), first, last);
        readBack(run, last);
        run.readBack(again_, sizeof(AgainState));
        if (Status ready = run.prepare(stages); !ready) return ready;
        whole_ = false;  // what fails from here on may leave nodes that are drawn changed in part: then all grows anew
        return run.add(std::move(stages), inputs.watch);
    };
    const auto waitsStill = [&](const Run& run, uint32_t last) -> Result<bool> {
        take(run, last, outcome);
        state = *run.got<AgainState>(2);
        if (outcome.waves.back().count == 0 || outcome.status.items > 0) return false;
        if (!goesOn(inputs.watch, outcome.status.nodes)) return stoppedFailure();
        return true;
    };
    Status grown =
        runWaves(runner_, "grow again", atOnce(inputs), likelyWaves_, inputs.limits.maxDepth + 1, add, waitsStill);
    whole_ = whole_ || grown || stopped(inputs);  // which is heeded before any is changed
    if (!grown) return grown.failure();
    const GrowStatus& s = outcome.status;
    const bool fits = s.chunks <= s.chunkCapacity && s.nodes <= s.nodeCapacity && s.branches <= s.branchCapacity &&
                      s.leaves <= s.leafCapacity && s.items <= room_.items;
    if (!fits) {
        room_.items = std::max(room_.items, s.items + s.items / 2);
        return Regrown::noRoom;
    }
    const uint64_t nodes = uint64_t(state.liveNodes) + s.nodes - state.nodeCount - state.goneNodes;
    const uint64_t chunks = uint64_t(state.liveChunks) + s.chunks - state.chunkCount - state.goneChunks;
    const bool whole = outcome.waves.back().count == 0 && state.overrun == 0;
    return whole && nodes <= state.mostNodes && chunks <= state.mostChunks ? Regrown::done : Regrown::tooMuch;
}

void Growth::publishAgain(const GrowthInputs& inputs, const Outcome& outcome, const AgainState& state,
                          Origin&& origin) {
    origin_ = std::move(origin);
    tablesStand_ = true;
    const GrowStatus& s = outcome.status;
    GrowthStats delta;
    takeCounters(s, delta);
    links_.swap();
    show(s, false);
    stats_.seeds = uint32_t(inputs.seeds.size() + inputs.frozen.size());
    stats_.derived = s.nodes - state.nodeCount;
    stats_.nodes += stats_.derived - state.goneNodes;
    stats_.chunks += s.chunks - state.chunkCount - state.goneChunks;
    stats_.branches += s.branches - state.branchCount - state.goneBranches;
    stats_.leaves += s.leaves - state.leafCount - state.goneLeaves;
    stats_.steps += s.steps - (state.goneNodes - state.goneInserted - state.goneFeet);
    stats_.inserted += s.inserted - state.goneInserted;
    stats_.stopped += s.stopped - state.goneStopped;
    stats_.deadEnds += s.deadEnds - state.goneDeadEnds;
    stats_.hash = uint64_t(uint32_t(stats_.hash >> 32) + uint32_t(delta.hash >> 32)) << 32 |
                  (uint32_t(stats_.hash) + uint32_t(delta.hash));
    countBytes(stats_);
    stats_.expandMs = outcome.marchMs + outcome.terminalsMs + outcome.fitMs;
    stats_.marchMs = outcome.marchMs;
    stats_.terminalsMs = outcome.terminalsMs;
    stats_.fitMs = outcome.fitMs;
    stats_.waves = wavesOf(outcome.waves);
    stats_.overflow = stats_.enlarged = 0;
    stats_.reservedBytes = reserved();
    stats_.expansions += 1;
    stats_.regrowths += 1;
}

Result<Growth::Regrown> Growth::regrow(const GrowthInputs& inputs, const SeedChanges& seeds) {
    if (inputs.changes->none() && !seeds.any && seeds.pruned.empty()) {
        stats_.derived = 0;
        return Regrown::done;
    }
    if (gappyLinks()) return Regrown::tooMuch;
    room_.items = std::max(room_.items, uint32_t(seeds.planted.size()));
    const std::vector<uint32_t> edits = editWords(inputs, seeds);
    if (Status made = makeAgainRoom(inputs, edits.size()); !made) return made.failure();
    const ExpandEnv env = environment(inputs, plants_.drawn(), links_.spare());
    Result<AgainState> found = findDirty(inputs, seeds, edits, env);
    if (!found) return found.failure();
    chained_ = true;
    touchedIsNew_ = false;
    if (found->counts[kListDirty] > stats_.chunks / kMostDirtyOf) return Regrown::tooMuch;
    const bool nothing = found->counts[kListDirty] + found->counts[kListBranches] + found->counts[kListGone] == 0;
    Origin origin = originOf(inputs);  // now, since nothing may fail between the change of what is drawn and the end
    if (nothing && !seeds.any) {
        origin_ = std::move(origin);
        tablesStand_ = true;
        stats_.derived = 0;
        return Regrown::done;
    }
    Outcome outcome;
    AgainState state{};
    Result<Regrown> grown = growAgain(inputs, env, outcome, state);
    if (!grown) return grown.failure();
    if (*grown == Regrown::noRoom) {
        room_.nodes = std::max(room_.nodes, stats_.nodes + stats_.nodes / 2);
        room_.leaves = std::max(room_.leaves, stats_.leaves + stats_.leaves / 2);
        room_.chunks = std::max(room_.chunks, view_.chunkCount + view_.chunkCount / 2);
        room_.branches = std::max(room_.branches, view_.branchCount + view_.branchCount / 2);
    }
    if (*grown != Regrown::done) return grown;
    publishAgain(inputs, outcome, state, std::move(origin));
    return Regrown::done;
}

}  // namespace espalier
