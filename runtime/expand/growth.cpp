// Expansion on the GPU (Buron 2015 §5, §7). In: seeds, rule maps, layers and surfaces by address. Out: nodes,
// chunks, branches and leaves. Waves of a queue are recorded ahead as indirect dispatches, which cost nothing when
// they turn out empty; the terminal passes follow in the same submission. What ran out of room is grown again with
// more, into a second set of buffers, so that the last good growth stands until the new one is complete.
#include <algorithm>
#include <cstddef>

#include "runtime/core/check.hpp"
#include "runtime/expand/gpu_growth.hpp"

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
    status.leafCapacity += status.leaves;
    status.nodeGroups[0] = r.nodes.empty() ? 0 : 1;
    status.branchGroups[0] = r.branches.empty() ? 0 : 1;
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

Status GpuGrowth::setUp() {
    struct Row {
        Program* program;
        const char* shader;
    };
    const Row rows[] = {
        {&packTables_, "expand/tables.comp"}, {&branchesFit_, "expand/branches.comp"}, {&fit_, "expand/fit.comp"}};
    for (const Row& row : rows) {
        Status made = load(*row.program, row.shader, {});
        if (!made) return made;
    }
    return Done{};
}

Status GpuGrowth::load(Program& program, const char* shader, std::vector<SpecConstant> constants) {
    if (program) return Done{};
    Result<Program> made = Program::compute(device_, shader, {.exact = true, .constants = std::move(constants)});
    if (!made) return made.failure();
    requireEqual(made->localSize()[0], kExpandGroup, "local size of an expansion kernel");
    program = std::move(*made);
    return Done{};
}

Status GpuGrowth::loadKernels(WalkMode mode) {
    const std::vector<SpecConstant> constants = {{0, byAddress_ ? 1u : 0u}, {2, features_}};
    const std::vector<SpecConstant> walking = {{0, byAddress_ ? 1u : 0u}, {1, fetches_ ? 0u : 1u}, {2, features_}};
    Status march = mode == WalkMode::paper ? load(marchPaper_[byAddress_], "expand/march_paper.comp", constants)
                                           : load(march_[marchNumber()], "expand/march.comp", walking);
    if (!march) return march;
    return load(terminals_[byAddress_], "expand/terminals.comp", constants);
}

Status GpuGrowth::ensure(Buffer& buffer, const char* name, uint64_t bytes, BufferUse use) {
    if (buffer && buffer.size() >= bytes) return Done{};
    buffer = {};
    Result<Buffer> made = Buffer::create(device_, name, bytes, use);
    if (!made) return made.failure();
    buffer = std::move(*made);
    return Done{};
}

// Binds all surfaces as texels, where that is possible and of use. The binding needs a view in any case.
Status GpuGrowth::viewSurfaces(const GrowthInputs& inputs) {
    const uint64_t most = 16ull * device_.info().limits.maxTexelBufferElements;
    const Buffer* data = inputs.surfaceData;
    fetches_ = device_.info().cpu && data && data->size() >= 16 && data->size() <= most;
    surfaceView_ = {};
    if (!fetches_) {
        Status made = ensure(noSurfaces_, "growth no surfaces", 16);
        if (!made) return made;
    }
    Result<TexelView> view = TexelView::create(device_, fetches_ ? *data : noSurfaces_, VK_FORMAT_R32G32B32A32_UINT);
    if (!view) return view.failure();
    surfaceView_ = std::move(*view);
    return Done{};
}

// Kernels for what these grammars ask of them.
Status GpuGrowth::makeKernels(const GrowthInputs& inputs) {
    uint64_t words = 0;
    placeTables(inputs, words);
    byAddress_ = words > kUniformTableWords;
    Status viewed = viewSurfaces(inputs);
    if (!viewed) return viewed;
    uint32_t features = features_ | kFeatureKnown;
    for (const RuleMapRef& map : inputs.grammars)
        features |= map.features == 0 ? kRuleFeatures : map.features & kRuleFeatures;
    if (inputs.limits.leafDensityCap > 0) features |= kFeatureDensity;
    if (inputs.limits.tangents == TangentMode::paper) features |= kFeatureJoints;
    if (features != features_) {
        for (auto* programs : {&march_, &marchAgain_})
            for (Program& program : *programs) program = {};
        for (auto* programs : {&marchPaper_, &terminals_, &terminalsAgain_})
            for (Program& program : *programs) program = {};
        features_ = features;
    }
    Status kernels = loadKernels(inputs.limits.walk);
    if (!kernels) return kernels;
    const uint64_t tableWords = byAddress_ ? words : kUniformTableWords;
    Status made = ensure(tables_, "growth tables", tableWords * 4);
    if (made) made = ensure(noTables_, "growth no tables", byAddress_ ? kUniformTableWords * 4 : 0);
    return made ? ensure(grammars_, "growth grammars", inputs.grammars.size() * sizeof(RuleMapRef)) : made;
}

Status GpuGrowth::makeRoom(const GrowthInputs& inputs, const GrowthRecords& frozen) {
    Status kernels = makeKernels(inputs);
    if (!kernels) return kernels;
    Plants& plants = plants_[1 - frontPlants_];
    Links& links = links_[1 - frontLinks_];
    const uint64_t waves = inputs.limits.maxDepth + 2ull;
    struct Row {
        Buffer* buffer;
        const char* name;
        uint64_t bytes;
    };
    const Row rows[] = {
        {&plants.nodes, "growth nodes", (room_.nodes + frozen.nodes.size()) * sizeof(Node)},
        {&plants.leaves, "growth leaves", (room_.leaves + frozen.leaves.size()) * sizeof(Leaf)},
        {&links.chunks, "growth chunks", (room_.chunks + frozen.chunks.size()) * sizeof(Chunk)},
        {&links.branches, "growth branches", (room_.branches + frozen.branches.size()) * sizeof(BranchRecord)},
        {&items_[0], "growth items even", uint64_t(room_.items) * sizeof(WorkItem)},
        {&items_[1], "growth items odd", uint64_t(room_.items) * sizeof(WorkItem)},
        {&status_, "growth status", sizeof(GrowStatus)},
        {&waves_, "growth waves", waves * sizeof(Wave)},
        {&density_, "growth density", densityWords(inputs.limits) * 4}};
    for (const Row& row : rows) {
        Status ok = ensure(*row.buffer, row.name, row.bytes);
        if (!ok) return ok;
    }
    return ensure(readback_, "growth readback", sizeof(GrowStatus) + waves * sizeof(Wave) + sizeof(AgainState),
                  BufferUse::readback);
}

ExpandEnv GpuGrowth::environment(const GrowthInputs& inputs, const Plants& plants, const Links& links) {
    ExpandEnv env{};
    env.surfaces = inputs.surfaces;
    if (fetches_) env.scratch = addressOf<UintBuf, uint32_t>(*inputs.surfaceData);
    env.layers = inputs.layers;
    env.grammars = addressOf<RuleMapBuf, RuleMapRef>(grammars_);
    env.tables = addressOf<UintBuf, uint32_t>(tables_);
    env.nodes = addressOf<NodeBuf, Node>(plants.nodes);
    env.chunks = addressOf<ChunkBuf, Chunk>(links.chunks);
    env.branches = addressOf<BranchBuf, BranchRecord>(links.branches);
    env.leaves = addressOf<LeafBuf, Leaf>(plants.leaves);
    env.itemCapacity = room_.items;
    env.status = addressOf<GrowStatusBuf, GrowStatus>(status_);
    env.waves = addressOf<WaveBuf, Wave>(waves_);
    env.density = addressOf<UintBuf, uint32_t>(density_);
    return env;
}

Status GpuGrowth::uploadTables(Commands& commands, const GrowthInputs& inputs) {
    std::vector<RuleMapRef> grammars(inputs.grammars.begin(), inputs.grammars.end());
    uint64_t words = 0;
    Status steps[] = {commands.upload(grammars_, grammars), commands.upload(tables_, placeTables(inputs, words))};
    for (Status& step : steps)
        if (!step) return step;
    commands.barrier(Use::transfer, Use::compute | Use::indirect);
    if (grammars.empty()) return Done{};
    Pass pass(commands, "expand tables");
    pass.dispatch(packTables_, {uint32_t(grammars.size()), 1, 1},
                  environment(inputs, plants_[frontPlants_], links_[frontLinks_]));
    pass.barrier(Use::compute, Use::compute);
    return Done{};
}

Status GpuGrowth::uploadStatus(Commands& commands, const GrowthInputs& inputs, GrowStatus status) {
    if (!inputs.pruned.empty()) {
        Status made = ensure(pruned_, "growth pruned", inputs.pruned.size_bytes());
        if (made) made = commands.upload(pruned_, keyWords(inputs.pruned));
        if (!made) return made;
        status.pruned = addressOf<UintBuf, uint32_t>(pruned_);
        status.prunedCount = uint32_t(inputs.pruned.size());
    }
    return commands.upload(status_, std::vector<GrowStatus>{status});
}

Status GpuGrowth::uploadInputs(Commands& commands, const GrowthInputs& inputs, const FrozenSum& frozen,
                               const GrowthCut& cut) {
    const Plants& plants = plants_[1 - frontPlants_];
    const Links& links = links_[1 - frontLinks_];
    const GrowthRecords& r = frozen.records;
    Status kept[] = {commands.upload(plants.nodes, r.nodes), commands.upload(plants.leaves, r.leaves),
                     commands.upload(links.chunks, r.chunks), commands.upload(links.branches, r.branches)};
    for (Status& step : kept)
        if (!step) return step;
    std::vector<Wave> wave(inputs.limits.maxDepth + 2u, Wave{0, {0, 1, 1}, 0, 0, 0, 0});
    wave[0] = firstWave(uint32_t(inputs.seeds.size()), room_);
    Status steps[] = {uploadStatus(commands, inputs, withFrozen(freshStatus(inputs.limits, room_, cut), frozen)),
                      commands.upload(waves_, wave), commands.upload(items_[0], itemsOfSeeds(inputs.seeds)),
                      uploadTables(commands, inputs)};
    for (Status& step : steps)
        if (!step) return step;
    return Done{};
}

void GpuGrowth::recordWaves(Pass& pass, const Program& march, bool fetching, const ExpandEnv& base, uint32_t first,
                            uint32_t last) {
    ExpandEnv env = base;
    for (uint32_t w = first; w < last; ++w) {
        env.wave = w;
        env.items = addressOf<WorkItemBuf, WorkItem>(items_[w & 1]);
        env.nextItems = addressOf<WorkItemBuf, WorkItem>(items_[(w + 1) & 1]);
        const uint64_t groups = w * sizeof(Wave) + offsetof(Wave, groups);
        if (fetching) {
            pass.dispatchIndirect(march, waves_, groups, env, {uniformTables(), surfaceView_});
        } else {
            pass.dispatchIndirect(march, waves_, groups, env, {uniformTables()});
        }
        pass.barrier(Use::compute | Use::indirect, Use::compute | Use::indirect);
    }
}

// Waves [first, last), then the terminal passes, which do nothing should wave `last` not be empty.
Status GpuGrowth::record(Commands& commands, const ExpandEnv& base, uint32_t first, uint32_t last,
                         const GrowthLimits& limits) {
    const bool paper = limits.walk == WalkMode::paper;
    const Program& march = paper ? marchPaper_[byAddress_] : march_[marchNumber()];
    {
        Pass pass(commands, "expand march");
        recordWaves(pass, march, !paper, base, first, last);
    }
    ExpandEnv env = base;
    env.wave = last;
    recordTerminals(commands, env, limits);
    commands.copy(status_, readback_, sizeof(GrowStatus));
    commands.copy(waves_, readback_, (last + 1) * sizeof(Wave), 0, sizeof(GrowStatus));
    commands.barrier(Use::transfer, Use::host);
    return Done{};
}

void GpuGrowth::recordTerminals(Commands& commands, ExpandEnv env, const GrowthLimits& limits) {
    const Program& terminals = terminals_[byAddress_];
    env.phase = kTerminalsWrite;
    constexpr uint64_t kNodes = offsetof(GrowStatus, nodeGroups), kBranches = offsetof(GrowStatus, branchGroups);
    bool capped = limits.leafDensityCap > 0, joined = limits.tangents == TangentMode::paper;
    if (capped || joined) {
        commands.fill(density_, 0);
        commands.barrier(Use::transfer, Use::compute);
    }
    {
        Pass pass(commands, "expand terminals");
        if (joined) {
            env.phase = kTerminalsJoints;
            pass.dispatchIndirect(branchesFit_, status_, kBranches, env);
            pass.barrier(Use::compute, Use::compute);
        }
        if (capped) {
            env.phase = kTerminalsCount;
            pass.dispatchIndirect(terminals, status_, kNodes, env, {uniformTables()});
            pass.barrier(Use::compute, Use::compute);
        }
        env.phase = kTerminalsWrite;
        pass.dispatchIndirect(terminals, status_, kNodes, env, {uniformTables()});
        pass.barrier(Use::compute, Use::compute);
    }
    Pass pass(commands, "expand fit");
    pass.dispatchIndirect(branchesFit_, status_, kBranches, env);
    pass.barrier(Use::compute, Use::compute);
    pass.dispatchIndirect(fit_, status_, kNodes, env);
    pass.barrier(Use::compute, Use::transfer | Use::compute | Use::indirect);
}

Result<GpuGrowth::Outcome> GpuGrowth::attempt(const GrowthInputs& inputs, const FrozenSum& frozen,
                                              const GrowthCut& cut) {
    Status room = makeRoom(inputs, frozen.records);
    if (!room) return room.failure();
    ExpandEnv env = environment(inputs, plants_[1 - frontPlants_], links_[1 - frontLinks_]);
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
        bool short1 = outcome.status.items > room_.items || outcome.status.chunks > outcome.status.chunkCapacity;
        if (outcome.waves[last].count == 0 || last == most || short1) return outcome;
        first = last;
        batch = batch * 2;
    }
}

GpuGrowth::Outcome GpuGrowth::readOutcome(uint32_t last) {
    Outcome outcome;
    std::memcpy(&outcome.status, readback_.mapped(), sizeof(GrowStatus));
    outcome.waves.resize(last + 1);
    std::memcpy(outcome.waves.data(), readback_.mapped() + sizeof(GrowStatus), (last + 1) * sizeof(Wave));
    return outcome;
}

// The links that were written are those of what is drawn from now on.
void GpuGrowth::showLinks(const GrowStatus& status) {
    frontLinks_ = 1 - frontLinks_;
    const Plants& plants = plants_[frontPlants_];
    const Links& links = links_[frontLinks_];
    view_.nodes = addressOf<NodeBuf, Node>(plants.nodes);
    view_.chunks = addressOf<ChunkBuf, Chunk>(links.chunks);
    view_.branches = addressOf<BranchBuf, BranchRecord>(links.branches);
    view_.leaves = addressOf<LeafBuf, Leaf>(plants.leaves);
    view_.nodeCount = status.nodes;
    view_.chunkCount = status.chunks;
    view_.branchCount = status.branches;
    view_.leafCount = status.leaves;
    view_.revision += 1;
}

void GpuGrowth::publish(const GrowthInputs& inputs, const FrozenSum& frozen, const Outcome& outcome) {
    frontPlants_ = 1 - frontPlants_;
    rangedLeaves_ = 0;
    showLinks(outcome.status);
    stats_.seeds = uint32_t(inputs.seeds.size() + inputs.frozen.size());
    takeCounters(outcome.status, stats_);
    stats_.derived = stats_.nodes - uint32_t(frozen.records.nodes.size());
    auto empty = std::find_if(outcome.waves.begin(), outcome.waves.end(), [](const Wave& w) { return w.count == 0; });
    stats_.waves = uint32_t(empty - outcome.waves.begin());
    likelyWaves_ = stats_.waves + 2;
    stats_.marchMs = outcome.marchMs;
    stats_.terminalsMs = outcome.terminalsMs;
    stats_.fitMs = outcome.fitMs;
    stats_.expandMs = outcome.marchMs + outcome.terminalsMs + outcome.fitMs;
    stats_.reservedBytes = reserved();
}

uint64_t GpuGrowth::reserved() const {
    uint64_t bytes = 0;
    for (const Plants& p : plants_) bytes += p.nodes.size() + p.leaves.size();
    for (const Links& l : links_) bytes += l.chunks.size() + l.branches.size();
    for (const Buffer* b : {&items_[0], &items_[1], &status_, &pruned_, &waves_, &grammars_, &tables_, &noTables_,
                            &density_, &again_, &marks_, &lists_, &edits_, &results_, &touched_, &leafRanges_})
        bytes += b->size();
    return bytes;
}

Result<GrowthRecords> GpuGrowth::read() {
    Plants& plants = plants_[frontPlants_];
    Links& links = links_[frontLinks_];
    GrowthRecords to;
    auto fetch = [&](auto& values, const Buffer& buffer, uint32_t count) -> Status {
        if (count == 0) return Done{};
        auto got = readVector<typename std::decay_t<decltype(values)>::value_type>(device_, buffer, 0, count);
        if (!got) return got.failure();
        values = std::move(*got);
        return Done{};
    };
    Status steps[] = {fetch(to.nodes, plants.nodes, view_.nodeCount), fetch(to.chunks, links.chunks, view_.chunkCount),
                      fetch(to.branches, links.branches, view_.branchCount),
                      fetch(to.leaves, plants.leaves, view_.leafCount)};
    for (Status& step : steps)
        if (!step) return step.failure();
    compactRecords(to);
    return to;
}

Status GpuGrowth::grow(const GrowthInputs& inputs) {
    Status usable = checkInputs(inputs);
    if (!usable) return usable;
    if (canRegrow(inputs)) {
        const std::optional<SeedChanges> seeds = seedChanges(from_, inputs);
        if (seeds && gappy())
            if (Status closed = compact(); !closed) return closed;
        Result<Regrown> done = seeds ? regrow(inputs, *seeds) : Result<Regrown>(Regrown::tooMuch);
        if (done && *done == Regrown::noRoom) {
            if (Status closed = compact(); !closed) return closed;
            done = regrow(inputs, *seeds);
        }
        surfaceView_ = {};  // no view outlives its buffer
        if (!done) return done.failure();
        if (*done == Regrown::done) return Done{};
    }
    return growAll(inputs);
}

void GpuGrowth::remember(const GrowthInputs& inputs) {
    limits_ = inputs.limits;
    surfaceCount_ = inputs.surfaceCount;
    maps_.assign(inputs.grammars.begin(), inputs.grammars.end());
    from_.seeds.assign(inputs.seeds.begin(), inputs.seeds.end());
    from_.frozen.assign(inputs.frozen.begin(), inputs.frozen.end());
    from_.pruned.assign(inputs.pruned.begin(), inputs.pruned.end());
    from_.widths.assign(inputs.widths.begin(), inputs.widths.end());
}

Status GpuGrowth::growAll(const GrowthInputs& inputs) {
    room_.items = std::max(room_.items, uint32_t(inputs.seeds.size()));
    const FrozenSum frozen = sumOf(inputs.frozen, uint32_t(inputs.seeds.size()));
    GrowthLimits limits = inputs.limits;  // for the rest
    const bool fits = frozen.records.nodes.size() < limits.maxNodes || inputs.seeds.empty();
    limits.maxNodes -= std::min(limits.maxNodes - 1, uint32_t(frozen.records.nodes.size()));
    GrowthCut cut = noCut(inputs.limits);
    uint32_t overflow = 0;
    for (uint32_t i = 0; fits && i < kMostAttempts; ++i) {
        Result<Outcome> outcome = attempt(inputs, frozen, cut);
        surfaceView_ = {};
        if (!outcome) return outcome.failure();
        Verdict verdict = judge(withoutFrozen(outcome->status, frozen.records), outcome->waves, limits, room_, cut);
        if (verdict == Verdict::impossible) break;
        if (verdict == Verdict::complete) {
            publish(inputs, frozen, *outcome);
            const GrowthCut none = noCut(inputs.limits);
            whole_ = cut.wave == none.wave && cut.key == none.key;
            stats_.overflow = overflow;
            stats_.expansions += 1;
            remember(inputs);
            return Done{};
        }
        overflow += 1;
    }
    return Failure("growth",
                   "the limit of " + std::to_string(inputs.limits.maxNodes) + " nodes leaves room for nothing");
}

Result<std::unique_ptr<Growth>> Growth::create(Device& device, const GrowthRoom& room) {
    auto growth = std::make_unique<GpuGrowth>(device, room);
    Status ready = growth->setUp();
    if (!ready) return ready.failure();
    return std::unique_ptr<Growth>(std::move(growth));
}

}  // namespace espalier
