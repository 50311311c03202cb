// Expansion on the GPU (Buron 2015 §5, §7). In: seeds, rule maps, layers and surfaces by address. Out: nodes,
// chunks, branches and leaves. Waves of a queue are recorded ahead as indirect dispatches, which cost nothing when
// they turn out empty; the terminal passes follow in the same submission. What ran out of room is grown again with
// more, into a second set of buffers, so that the last good growth stands until the new one is complete.
#include "runtime/expand/growth.hpp"

#include <algorithm>
#include <array>
#include <cstddef>

#include "runtime/core/check.hpp"
#include "runtime/expand/growth_plan.hpp"
#include "runtime/gpu/buffer.hpp"
#include "runtime/gpu/commands.hpp"
#include "runtime/gpu/program.hpp"
#include "shaders/shared/expand_tables.h"

namespace espalier {
namespace {

constexpr uint32_t kMostAttempts = 48;

// The records of one growth.
struct Records {
    Buffer nodes, chunks, branches, leaves;
};

template <class Buf, class T>
Buf addressOf(const Buffer& buffer, uint64_t offset = 0) {
    return Buf{reinterpret_cast<T*>(buffer.address() + offset)};
}

class GpuGrowth final : public Growth {
  public:
    GpuGrowth(Device& device, const GrowthRoom& room) : device_(device), room_(room) {}

    Status setUp();
    Status load(Program& program, const char* shader, std::vector<SpecConstant> constants);
    Status loadKernels(WalkMode mode);
    Status grow(const GrowthInputs& inputs) override;
    GrowthView view() const override { return view_; }
    GrowthStats stats() const override { return stats_; }
    Result<GrowthRecords> read() override;

  private:
    struct Outcome {
        GrowStatus status;
        std::vector<Wave> waves;
        double marchMs = 0, terminalsMs = 0, fitMs = 0;
    };
    Result<Outcome> attempt(const GrowthInputs& inputs, const GrowthCut& cut);
    Status makeRoom(const GrowthInputs& inputs);
    uint64_t densityWords(const GrowthLimits& limits) const {
        if (limits.tangents == TangentMode::paper) return kDensityCells + 3ull * room_.nodes;
        return limits.leafDensityCap > 0 ? kDensityCells : 1;
    }
    // The packed tables for kernels' uniform binding: something of its size when they are read by address.
    uint32_t marchNumber() const { return (fetches_ ? 2 : 0) + (byAddress_ ? 1 : 0); }
    Status viewSurfaces(const GrowthInputs& inputs);
    const Buffer& uniformTables() const { return byAddress_ ? noTables_ : tables_; }
    Status ensure(Buffer& buffer, const char* name, uint64_t bytes, BufferUse use = BufferUse::device);
    Status uploadInputs(Commands& commands, const GrowthInputs& inputs, const GrowthCut& cut);
    Status record(Commands& commands, const ExpandEnv& env, uint32_t first, uint32_t last, const GrowthLimits& limits);
    void recordTerminals(Commands& commands, ExpandEnv env, const GrowthLimits& limits);
    ExpandEnv environment(const GrowthInputs& inputs);
    void publish(const GrowthInputs& inputs, const Outcome& outcome);
    uint64_t reserved() const;

    Device& device_;
    GrowthRoom room_;
    uint32_t likelyWaves_ = 24;  // recorded in the first submission
    // Made when first asked for; [1] reads tables by address, see kUniformTableWords.
    std::array<Program, 4> march_;  // [2], [3] fetch surfaces as texels
    std::array<Program, 2> marchPaper_, terminals_;
    uint32_t features_ = 0;  // that these are specialised to: all that grammars ever used, so that they settle
    Program packTables_, branchesFit_, fit_;
    bool byAddress_ = false;
    bool fetches_ = false;
    TexelView surfaceView_;
    Records sets_[2];
    uint32_t front_ = 0;
    Buffer items_[2], status_, waves_, grammars_, tables_, noTables_, noSurfaces_, density_, readback_;
    GrowthView view_;
    GrowthStats stats_;
};

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

Status GpuGrowth::makeRoom(const GrowthInputs& inputs) {
    Records& back = sets_[1 - front_];
    uint64_t waves = inputs.limits.maxDepth + 2ull, words = 0;
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
        for (Program& program : march_) program = {};
        for (Program& program : marchPaper_) program = {};
        for (Program& program : terminals_) program = {};
        features_ = features;
    }
    Status kernels = loadKernels(inputs.limits.walk);
    if (!kernels) return kernels;
    struct Row {
        Buffer* buffer;
        const char* name;
        uint64_t bytes;
    };
    const Row rows[] = {{&back.nodes, "growth nodes", uint64_t(room_.nodes) * sizeof(Node)},
                        {&back.chunks, "growth chunks", uint64_t(room_.chunks) * sizeof(Chunk)},
                        {&back.branches, "growth branches", uint64_t(room_.branches) * sizeof(BranchRecord)},
                        {&back.leaves, "growth leaves", uint64_t(room_.leaves) * sizeof(Leaf)},
                        {&items_[0], "growth items even", uint64_t(room_.items) * sizeof(WorkItem)},
                        {&items_[1], "growth items odd", uint64_t(room_.items) * sizeof(WorkItem)},
                        {&status_, "growth status", sizeof(GrowStatus)},
                        {&waves_, "growth waves", waves * sizeof(Wave)},
                        {&grammars_, "growth grammars", inputs.grammars.size() * sizeof(RuleMapRef)},
                        {&tables_, "growth tables", byAddress_ ? words * 4 : kUniformTableWords * 4},
                        {&noTables_, "growth no tables", byAddress_ ? kUniformTableWords * 4 : 0},
                        {&density_, "growth density", densityWords(inputs.limits) * 4}};
    for (const Row& row : rows) {
        Status ok = ensure(*row.buffer, row.name, row.bytes);
        if (!ok) return ok;
    }
    return ensure(readback_, "growth readback", sizeof(GrowStatus) + waves * sizeof(Wave), BufferUse::readback);
}

ExpandEnv GpuGrowth::environment(const GrowthInputs& inputs) {
    Records& back = sets_[1 - front_];
    ExpandEnv env{};
    env.surfaces = inputs.surfaces;
    if (fetches_) env.scratch = addressOf<UintBuf, uint32_t>(*inputs.surfaceData);
    env.layers = inputs.layers;
    env.grammars = addressOf<RuleMapBuf, RuleMapRef>(grammars_);
    env.tables = addressOf<UintBuf, uint32_t>(tables_);
    env.nodes = addressOf<NodeBuf, Node>(back.nodes);
    env.chunks = addressOf<ChunkBuf, Chunk>(back.chunks);
    env.branches = addressOf<BranchBuf, BranchRecord>(back.branches);
    env.leaves = addressOf<LeafBuf, Leaf>(back.leaves);
    env.itemCapacity = room_.items;
    env.status = addressOf<GrowStatusBuf, GrowStatus>(status_);
    env.waves = addressOf<WaveBuf, Wave>(waves_);
    env.density = addressOf<UintBuf, uint32_t>(density_);
    return env;
}

Status GpuGrowth::uploadInputs(Commands& commands, const GrowthInputs& inputs, const GrowthCut& cut) {
    std::vector<GrowStatus> status{freshStatus(inputs.limits, room_, cut)};
    std::vector<Wave> wave(inputs.limits.maxDepth + 2u, Wave{0, {0, 1, 1}, 0, 0, 0, 0});
    wave[0] = firstWave(uint32_t(inputs.seeds.size()), room_);
    std::vector<RuleMapRef> grammars(inputs.grammars.begin(), inputs.grammars.end());
    uint64_t words = 0;
    std::vector<GrammarTables> tables = placeTables(inputs, words);
    Status steps[] = {commands.upload(status_, status), commands.upload(waves_, wave),
                      commands.upload(items_[0], itemsOfSeeds(inputs.seeds)), commands.upload(grammars_, grammars),
                      commands.upload(tables_, tables)};
    for (Status& step : steps)
        if (!step) return step;
    commands.barrier(Use::transfer, Use::compute | Use::indirect);
    if (grammars.empty()) return Done{};
    Pass pass(commands, "expand tables");
    pass.dispatch(packTables_, {uint32_t(grammars.size()), 1, 1}, environment(inputs));
    pass.barrier(Use::compute, Use::compute);
    return Done{};
}

// Waves [first, last), then the terminal passes, which do nothing should wave `last` not be empty.
Status GpuGrowth::record(Commands& commands, const ExpandEnv& base, uint32_t first, uint32_t last,
                         const GrowthLimits& limits) {
    const bool paper = limits.walk == WalkMode::paper;
    const Program& march = paper ? marchPaper_[byAddress_] : march_[marchNumber()];
    {
        Pass pass(commands, "expand march");
        ExpandEnv env = base;
        for (uint32_t w = first; w < last; ++w) {
            env.wave = w;
            env.items = addressOf<WorkItemBuf, WorkItem>(items_[w & 1]);
            env.nextItems = addressOf<WorkItemBuf, WorkItem>(items_[(w + 1) & 1]);
            const uint64_t groups = w * sizeof(Wave) + offsetof(Wave, groups);
            if (paper) {
                pass.dispatchIndirect(march, waves_, groups, env, {uniformTables()});
            } else {
                pass.dispatchIndirect(march, waves_, groups, env, {uniformTables(), surfaceView_});
            }
            pass.barrier(Use::compute | Use::indirect, Use::compute | Use::indirect);
        }
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

Result<GpuGrowth::Outcome> GpuGrowth::attempt(const GrowthInputs& inputs, const GrowthCut& cut) {
    Status room = makeRoom(inputs);
    if (!room) return room.failure();
    ExpandEnv env = environment(inputs);
    Outcome outcome;
    uint32_t first = 0;
    uint32_t most = inputs.limits.maxDepth + 1;
    uint32_t batch = std::min(likelyWaves_, most);
    while (true) {
        uint32_t last = std::min(first + batch, most);
        Result<Commands> commands = Commands::begin(device_, "expand");
        if (!commands) return commands.failure();
        if (first == 0) {
            Status uploaded = uploadInputs(*commands, inputs, cut);
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
        std::memcpy(&outcome.status, readback_.mapped(), sizeof(GrowStatus));
        outcome.waves.resize(last + 1);
        std::memcpy(outcome.waves.data(), readback_.mapped() + sizeof(GrowStatus), (last + 1) * sizeof(Wave));
        bool short1 = outcome.status.items > room_.items || outcome.status.chunks > room_.chunks;
        if (outcome.waves[last].count == 0 || last == most || short1) return outcome;
        first = last;
        batch = batch * 2;
    }
}

void GpuGrowth::publish(const GrowthInputs& inputs, const Outcome& outcome) {
    front_ = 1 - front_;
    Records& records = sets_[front_];
    view_.nodes = addressOf<NodeBuf, Node>(records.nodes);
    view_.chunks = addressOf<ChunkBuf, Chunk>(records.chunks);
    view_.branches = addressOf<BranchBuf, BranchRecord>(records.branches);
    view_.leaves = addressOf<LeafBuf, Leaf>(records.leaves);
    view_.nodeCount = outcome.status.nodes;
    view_.chunkCount = outcome.status.chunks;
    view_.branchCount = outcome.status.branches;
    view_.leafCount = outcome.status.leaves;
    view_.revision += 1;
    stats_.seeds = uint32_t(inputs.seeds.size());
    takeCounters(outcome.status, stats_);
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
    for (const Records& r : sets_) bytes += r.nodes.size() + r.chunks.size() + r.branches.size() + r.leaves.size();
    for (const Buffer* b : {&items_[0], &items_[1], &status_, &waves_, &grammars_, &tables_, &noTables_, &density_})
        bytes += b->size();
    return bytes;
}

Result<GrowthRecords> GpuGrowth::read() {
    Records& from = sets_[front_];
    GrowthRecords to;
    auto fetch = [&](auto& values, const Buffer& buffer, uint32_t count) -> Status {
        if (count == 0) return Done{};
        auto got = readVector<typename std::decay_t<decltype(values)>::value_type>(device_, buffer, 0, count);
        if (!got) return got.failure();
        values = std::move(*got);
        return Done{};
    };
    Status steps[] = {fetch(to.nodes, from.nodes, view_.nodeCount), fetch(to.chunks, from.chunks, view_.chunkCount),
                      fetch(to.branches, from.branches, view_.branchCount),
                      fetch(to.leaves, from.leaves, view_.leafCount)};
    for (Status& step : steps)
        if (!step) return step.failure();
    return to;
}

Status GpuGrowth::grow(const GrowthInputs& inputs) {
    Status usable = checkInputs(inputs);
    if (!usable) return usable;
    room_.items = std::max(room_.items, uint32_t(inputs.seeds.size()));
    GrowthCut cut = noCut(inputs.limits);
    uint32_t overflow = 0;
    for (uint32_t i = 0; i < kMostAttempts; ++i) {
        Result<Outcome> outcome = attempt(inputs, cut);
        surfaceView_ = {};  // no view outlives its buffer
        if (!outcome) return outcome.failure();
        Verdict verdict = judge(outcome->status, outcome->waves, inputs.limits, room_, cut);
        if (verdict == Verdict::impossible) break;
        if (verdict == Verdict::complete) {
            publish(inputs, *outcome);
            stats_.overflow = overflow;
            stats_.expansions += 1;
            return Done{};
        }
        overflow += 1;
    }
    return Failure("growth",
                   "the limit of " + std::to_string(inputs.limits.maxNodes) + " nodes leaves room for nothing");
}

}  // namespace

Result<std::unique_ptr<Growth>> Growth::create(Device& device, const GrowthRoom& room) {
    auto growth = std::make_unique<GpuGrowth>(device, room);
    Status ready = growth->setUp();
    if (!ready) return ready.failure();
    return std::unique_ptr<Growth>(std::move(growth));
}

}  // namespace espalier
