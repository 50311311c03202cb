// What full growth and regrowth share on the host: kernels for what a scene's grammars use, buffers, packed tables, and
// the records that are drawn.
#include <algorithm>

#include "runtime/core/check.hpp"
#include "runtime/expand/growth.hpp"
#include "runtime/gpu/limits.hpp"

namespace espalier {

Status Growth::setUp() {
    return kernels_.make({GrowthKernel::tables, GrowthKernel::branches}, tablesByAddress_);
}

Status Growth::ensure(Buffer& buffer, const char* name, uint64_t bytes, BufferUse use) {
    if (buffer.size() < bytes) buffer = {};  // before the new one, for which there may be no room beside it
    return makeAtLeast(device_, buffer, name, bytes, use);
}

// Room for the chains of leaves on nodes. What gets new room has to be chained anew.
Status Growth::ensureChains(const Plants& plants) {
    const uint64_t nodes = capacityOf<Node>(plants.nodes) * 4ull, leaves = capacityOf<Leaf>(plants.leaves) * 4ull;
    if (!firstLeaves_ || firstLeaves_.size() < nodes || !nextLeaves_ || nextLeaves_.size() < leaves) chained_ = false;
    if (Status ok = ensure(firstLeaves_, "growth first leaves", nodes); !ok) return ok;
    return ensure(nextLeaves_, "growth next leaves", leaves);
}

Status Growth::makeTables(const GrowthInputs& inputs) {
    uint64_t words = 0;
    placeTables(inputs, words);
    tablesByAddress_ = words > kUniformTableWords;
    static_assert(kUniformTableWords * 4 == kUniformBytes);
    const uint64_t tables = tablesByAddress_ ? words * 4 : kUniformBytes;
    const uint64_t grammars = inputs.grammars.size() * sizeof(RuleMapRef);
    if (!tablesByAddress_ && tables_.size() > kUniformBytes) tables_ = {};
    tablesStand_ = tablesStand_ && tables_.size() >= tables && grammars_.size() >= grammars;
    Status made = ensure(tables_, "growth tables", tables);
    if (made) made = ensure(noTables_, "growth no tables", tablesByAddress_ ? kUniformBytes : 0);
    return made ? ensure(grammars_, "growth grammars", grammars) : made;
}

// Kernels for what these grammars ask of them.
Status Growth::makeKernels(const GrowthInputs& inputs) {
    uint32_t features = kFeatureKnown;
    for (const RuleMapRef& map : inputs.grammars)
        features |= map.features == 0 ? kRuleFeatures : map.features & kRuleFeatures;
    if (inputs.limits.leafDensityCap > 0) features |= kFeatureDensity;
    if (inputs.limits.tangents == TangentMode::paper) features |= kFeatureJoints;
    kernels_.use(features);
    if (Status made = ensure(lanes_, "growth lanes", laneBytes()); !made) return made;
    return kernels_.make({marchOf(inputs.limits), GrowthKernel::terminals, GrowthKernel::fit}, tablesByAddress_);
}

// Edits add nodes and leaves before gaps are closed. Where memory that isn't touched costs nothing, there is room for
// these at once, if there is any: what outgrows its room is copied whole.
Status Growth::makeRoom(const GrowthInputs& inputs, const GrowthRecords& frozen) {
    if (inputs.native && device_.info().cpu) {
        if (Status made = makeRoom(inputs, frozen, true); made) return made;
        plants_.spare() = {};
    }
    return makeRoom(inputs, frozen, false);
}

Status Growth::makeRoom(const GrowthInputs& inputs, const GrowthRecords& frozen, bool spare) {
    Plants& plants = plants_.spare();
    Links& links = links_.spare();
    struct Row {
        Buffer* buffer;
        const char* name;
        uint64_t bytes;
    };
    const uint64_t most = device_.info().maxBufferBytes / 16 * 16;
    const auto withSpare = [&](uint64_t bytes) {
        return spare ? std::max(bytes, std::min(wholeTexels(bytes + bytes / 2), most)) : bytes;
    };
    const Row rows[] = {
        {&plants.nodes, "growth nodes", withSpare(wholeTexels((room_.nodes + frozen.nodes.size()) * sizeof(Node)))},
        {&plants.leaves, "growth leaves", withSpare((room_.leaves + frozen.leaves.size()) * sizeof(Leaf))},
        {&links.chunks, "growth chunks", (room_.chunks + frozen.chunks.size()) * sizeof(Chunk)},
        {&links.branches, "growth branches", (room_.branches + frozen.branches.size()) * sizeof(BranchRecord)},
        {&density_, "growth density", densityWords(inputs.limits, frozen.nodes.size()) * 4}};
    for (const Row& row : rows) {
        Status ok = ensure(*row.buffer, row.name, row.bytes);
        if (!ok) return ok;
    }
    chained_ = false;  // the attempt writes its own
    if (Status ok = ensureChains(plants); !ok) return ok;
    if (Status tables = makeTables(inputs); !tables) return tables;
    if (Status queues = makeQueues(inputs); !queues || runsNative(inputs)) return queues;
    return makeKernels(inputs);
}

Status Growth::makeQueues(const GrowthInputs& inputs) {
    const uint64_t waves = inputs.limits.maxDepth + 2ull;
    const uint64_t items = uint64_t(room_.items) * sizeof(WorkItem);
    return allDone({ensure(items_[0], "growth items even", items), ensure(items_[1], "growth items odd", items),
                    ensure(status_, "growth status", sizeof(GrowStatus)),
                    ensure(waves_, "growth waves", waves * sizeof(Wave)),
                    ensure(readback_, "growth readback", sizeof(GrowStatus) + waves * sizeof(Wave) + sizeof(AgainState),
                           BufferUse::readback)});
}

ExpandEnv Growth::environment(const GrowthInputs& inputs, const Plants& plants, const Links& links) {
    ExpandEnv env{};
    env.surfaces = inputs.surfaces;
    env.layers = inputs.layers;
    env.grammars = addressOf<RuleMapBuf>(grammars_);
    env.tables = addressOf<UintBuf>(tables_);
    env.nodes = addressOf<NodeBuf>(plants.nodes);
    env.chunks = addressOf<ChunkBuf>(links.chunks);
    env.branches = addressOf<BranchBuf>(links.branches);
    env.leaves = addressOf<LeafBuf>(plants.leaves);
    env.itemCapacity = room_.items;
    env.status = addressOf<GrowStatusBuf>(status_);
    env.waves = addressOf<WaveBuf>(waves_);
    env.density = addressOf<UintBuf>(density_);
    return env;
}

Status Growth::uploadTables(Commands& commands, const GrowthInputs& inputs, bool pack) {
    tablesStand_ = false;
    std::vector<RuleMapRef> grammars(inputs.grammars.begin(), inputs.grammars.end());
    uint64_t words = 0;
    if (Status s =
            allDone({commands.upload(grammars_, grammars), commands.upload(tables_, placeTables(inputs, words))});
        !s)
        return s;
    commands.barrier(Use::transfer, Use::compute | Use::indirect);
    if (grammars.empty() || !pack) return Done{};
    Pass pass(commands, "expand tables");
    stats_.dispatches += 1;
    pass.dispatch(kernel(GrowthKernel::tables), {uint32_t(grammars.size()), 1, 1},
                  environment(inputs, plants_.drawn(), links_.drawn()));
    pass.barrier(Use::compute, Use::compute);
    return Done{};
}

Status Growth::uploadStatus(Commands& commands, const GrowthInputs& inputs, GrowStatus status) {
    if (!inputs.pruned.empty()) {
        Status made = ensure(pruned_, "growth pruned", inputs.pruned.size_bytes());
        if (made) made = commands.upload(pruned_, keyWords(inputs.pruned));
        if (!made) return made;
        status.pruned = addressOf<UintBuf>(pruned_);
        status.prunedCount = uint32_t(inputs.pruned.size());
    }
    status.firstLeaves = addressOf<UintBuf>(firstLeaves_);
    status.nextLeaves = addressOf<UintBuf>(nextLeaves_);
    return commands.upload(status_, std::vector<GrowStatus>{status});
}

Growth::Outcome Growth::readOutcome(uint32_t last) {
    Outcome outcome;
    std::memcpy(&outcome.status, readback_.mapped(), sizeof(GrowStatus));
    outcome.waves.resize(last + 1);
    std::memcpy(outcome.waves.data(), readback_.mapped() + sizeof(GrowStatus), (last + 1) * sizeof(Wave));
    return outcome;
}

void Growth::lookAtFront() {
    const Plants& plants = plants_.drawn();
    const Links& links = links_.drawn();
    view_.nodes = addressOf<NodeBuf>(plants.nodes);
    view_.chunks = addressOf<ChunkBuf>(links.chunks);
    view_.branches = addressOf<BranchBuf>(links.branches);
    view_.leaves = addressOf<LeafBuf>(plants.leaves);
    view_.nodeBuffer = &plants.nodes;
    view_.chunkBuffer = &links.chunks;
    view_.leafBuffer = &plants.leaves;
}

void Growth::show(const GrowStatus& status, bool all) {
    lookAtFront();
    view_.nodeCount = status.nodes;
    view_.chunkCount = status.chunks;
    view_.branchCount = status.branches;
    view_.leafCount = status.leaves;
    view_.revision += 1;
    view_.number += 1;
    if (all) view_.renewed = view_.number;
    view_.touched = all ? nullptr : &touched_;
    if (all) view_.moved = {};
}

uint64_t Growth::reserved() const {
    uint64_t bytes = 0;
    for (const Plants& p : plants_.sets) bytes += p.nodes.size() + p.leaves.size();
    for (const Links& l : links_.sets) bytes += l.chunks.size() + l.branches.size();
    for (const Buffer* b : {&items_[0], &items_[1],    &lanes_,      &status_,  &pruned_,    &waves_,     &grammars_,
                            &tables_,   &noTables_,    &density_,    &again_,   &marks_,     &lists_,     &edits_,
                            &results_,  &firstLeaves_, &nextLeaves_, &touched_, &nodesWent_, &leavesWent_})
        bytes += b->size();
    return bytes;
}

Result<GrowthRecords> Growth::read() {
    Plants& plants = plants_.drawn();
    Links& links = links_.drawn();
    GrowthRecords to;
    auto fetch = [&](auto& values, const Buffer& buffer, uint32_t count) -> Status {
        if (count == 0) return Done{};
        auto got = readVector<typename std::decay_t<decltype(values)>::value_type>(device_, buffer, 0, count);
        if (!got) return got.failure();
        values = std::move(*got);
        return Done{};
    };
    if (Status s = allDone(
            {fetch(to.nodes, plants.nodes, view_.nodeCount), fetch(to.chunks, links.chunks, view_.chunkCount),
             fetch(to.branches, links.branches, view_.branchCount), fetch(to.leaves, plants.leaves, view_.leafCount)});
        !s)
        return s.failure();
    compactRecords(to);
    return to;
}

// What every edit uses stays as large as edits of what stands ask for it.
void Growth::trim() {
    const auto fit = [](uint32_t& room, uint32_t needed, uint32_t least) {
        room = std::min<uint64_t>(room, std::max<uint64_t>(needed + needed / 2ull, least));
    };
    fit(room_.chunks, view_.chunkCount, least_.chunks);
    fit(room_.nodes, view_.nodeCount, least_.nodes);
    fit(room_.branches, view_.branchCount, least_.branches);
    fit(room_.leaves, view_.leafCount, least_.leaves);
    fit(room_.items, widest_, least_.items);
    (void)shrink();  // where there isn't memory even for less, all stays where it is
    const Plants& plants = plants_.drawn();
    const Links& links = links_.drawn();
    const AgainBytes again = againBytes(links);
    const struct {
        Buffer* buffer;
        uint64_t bytes;
    } rows[] = {{&items_[0], room_.items * sizeof(WorkItem)},
                {&items_[1], room_.items * sizeof(WorkItem)},
                {&lanes_, lanes_ ? laneBytes() : 0},
                {&links_.spare().chunks, again.chunks},
                {&links_.spare().branches, again.branches},
                {&marks_, again.marks},
                {&lists_, again.lists},
                {&results_, again.results},
                {&edits_, kLeastEditBytes},
                {&firstLeaves_, capacityOf<Node>(plants.nodes) * 4ull},
                {&nextLeaves_, capacityOf<Leaf>(plants.leaves) * 4ull},
                {&touched_, view_.touched ? touched_.size() : 0},
                {&nodesWent_, view_.moved.nodes ? nodesWent_.size() : 0},
                {&leavesWent_, view_.moved.leaves ? leavesWent_.size() : 0}};
    for (const auto& row : rows)
        if (row.buffer->size() > row.bytes) *row.buffer = {};
    chained_ = chained_ && firstLeaves_ && nextLeaves_;
    stats_.reservedBytes = reserved();
}

Growth::Origin Growth::originOf(const GrowthInputs& inputs) {
    Origin origin;
    origin.seeds.assign(inputs.seeds.begin(), inputs.seeds.end());
    origin.frozen.assign(inputs.frozen.begin(), inputs.frozen.end());
    origin.pruned.assign(inputs.pruned.begin(), inputs.pruned.end());
    origin.widths.assign(inputs.widths.begin(), inputs.widths.end());
    origin.limits = inputs.limits;
    origin.maps.assign(inputs.grammars.begin(), inputs.grammars.end());
    return origin;
}

Result<std::unique_ptr<Growth>> Growth::create(Device& device, const GrowthRoom& room) {
    std::unique_ptr<Growth> growth(new Growth(device, room));
    Status ready = growth->setUp();
    if (!ready) return ready.failure();
    return growth;
}

}  // namespace espalier
