// What full growth and regrowth share on the host: kernels for what a scene's grammars use, buffers, packed tables, and
// the records that are drawn.
#include <algorithm>

#include "runtime/core/check.hpp"
#include "runtime/expand/growth.hpp"
#include "runtime/gpu/limits.hpp"

namespace espalier {

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
    noticeFeatures(inputs);
    return made ? ensure(grammars_, "growth grammars", grammars) : made;
}

// Kernels are made for what grammars ask of them.
void Growth::noticeFeatures(const GrowthInputs& inputs) {
    uint32_t features = features_ | kFeatureKnown;
    for (const RuleMapRef& map : inputs.grammars)
        features |= map.features == 0 ? kRuleFeatures : map.features & kRuleFeatures;
    if (inputs.limits.leafDensityCap > 0) features |= kFeatureDensity;
    if (inputs.limits.tangents == TangentMode::paper) features |= kFeatureJoints;
    if (reachOf(inputs) > 0) features |= kFeatureAvoid;
    if (features != features_) runner_.dropPrograms(kConstantFeatures);
    features_ = features;
}

// Edits add nodes and leaves before gaps are closed. Where memory that isn't touched costs nothing, there is room for
// these at once, if there is any: what outgrows its room is copied whole.
Status Growth::makeRoom(const GrowthInputs& inputs, const GrowthRecords& frozen) {
    if (inputs.native && device_.info().traits.lazyMemory) {
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
    if (Status ok = makeAvoidRoom(inputs, frozen); !ok) return ok;
    chained_ = false;  // the attempt writes its own
    if (Status ok = ensureChains(plants); !ok) return ok;
    if (Status tables = makeTables(inputs); !tables) return tables;
    return makeQueues(inputs);
}

// The grid of stems that keep a distance.
Status Growth::makeAvoidRoom(const GrowthInputs& inputs, const GrowthRecords& frozen) {
    if (reachOf(inputs) <= 0) return Done{};
    room_.avoid = std::max<uint32_t>(room_.avoid, 2 * (room_.nodes + uint32_t(frozen.nodes.size())));
    return allDone({ensure(avoidHeads_, "growth grid", avoidCells(room_) * 4ull),
                    ensure(avoidEntries_, "growth grid entries", room_.avoid * 8ull),
                    ensure(avoidBounds_, "growth bounds", (room_.chunks + frozen.chunks.size()) * 4)});
}

Status Growth::makeQueues(const GrowthInputs& inputs) {
    const uint64_t waves = inputs.limits.maxDepth + 2ull;
    const uint64_t items = uint64_t(room_.items) * sizeof(WorkItem);
    return allDone({ensure(items_[0], "growth items even", items), ensure(items_[1], "growth items odd", items),
                    ensure(status_, "growth status", sizeof(GrowStatus)),
                    ensure(waves_, "growth waves", waves * sizeof(Wave))});
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

GrowthShaders Growth::shaders() const {
    return {&waves_, &status_, &uniformTables(), tablesByAddress_, features_, laneBytes(), groupsThroughChunks()};
}

Status Growth::uploadTables(Commands& commands, const GrowthInputs& inputs) {
    tablesStand_ = false;
    std::vector<RuleMapRef> grammars(inputs.grammars.begin(), inputs.grammars.end());
    uint64_t words = 0;
    return allDone({commands.upload(grammars_, grammars), commands.upload(tables_, placeTables(inputs, words))});
}

Status Growth::uploadStatus(Commands& commands, const GrowthInputs& inputs, GrowStatus status) {
    if (!inputs.pruned.empty()) {
        Status made = ensure(pruned_, "growth pruned", inputs.pruned.size_bytes());
        if (made) made = commands.upload(pruned_, keyWords(inputs.pruned));
        if (!made) return made;
        status.pruned = addressOf<UintBuf>(pruned_);
        status.prunedCount = uint32_t(inputs.pruned.size());
    }
    if (status.avoidReach > 0) {
        status.avoidHeads = addressOf<UintBuf>(avoidHeads_);
        status.avoidEntries = addressOf<UintBuf>(avoidEntries_);
        status.avoidBounds = addressOf<UintBuf>(avoidBounds_);
    }
    status.firstLeaves = addressOf<UintBuf>(firstLeaves_);
    status.nextLeaves = addressOf<UintBuf>(nextLeaves_);
    return commands.upload(status_, std::vector<GrowStatus>{status});
}

void Growth::readBack(Run& run, uint32_t last) const {
    run.readBack(status_, sizeof(GrowStatus));
    run.readBack(waves_, (last + 1) * sizeof(Wave));
}

void Growth::take(const Run& run, uint32_t last, Outcome& outcome) {
    outcome.status = *run.got<GrowStatus>(0);
    const std::span<const Wave> waves(run.got<Wave>(1), last + 1);
    outcome.waves.assign(waves.begin(), waves.begin() + std::min(wavesOf(waves), last) + 1);
    outcome.marchMs += run.milliseconds("expand march");
    outcome.terminalsMs += run.milliseconds("expand terminals");
    outcome.fitMs += run.milliseconds("expand fit");
    stats_.native = run.atOnce();
    stats_.dispatches += run.dispatches();
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
    uint64_t bytes = runner_.reserved();
    for (const Plants& p : plants_.sets) bytes += p.nodes.size() + p.leaves.size();
    for (const Links& l : links_.sets) bytes += l.chunks.size() + l.branches.size();
    for (const Buffer* b :
         {&avoidHeads_, &avoidEntries_, &avoidBounds_, &items_[0], &items_[1],  &status_,    &pruned_, &waves_,
          &grammars_,   &tables_,       &noTables_,    &density_,  &again_,     &marks_,     &lists_,  &edits_,
          &results_,    &firstLeaves_,  &nextLeaves_,  &touched_,  &nodesWent_, &leavesWent_})
        bytes += b->size();
    return bytes;
}

Result<GrowthRecords> Growth::read() {
    Plants& plants = plants_.drawn();
    Links& links = links_.drawn();
    GrowthRecords to;
    if (Status s = allDone({readRecords(device_, plants.nodes, view_.nodeCount, to.nodes),
                            readRecords(device_, links.chunks, view_.chunkCount, to.chunks),
                            readRecords(device_, links.branches, view_.branchCount, to.branches),
                            readRecords(device_, plants.leaves, view_.leafCount, to.leaves)});
        !s)
        return s.failure();
    compactRecords(to);
    return to;
}

// What every edit uses stays as large as edits of what stands ask for it.
void Growth::trim() {
    shrinkRoom(room_.chunks, view_.chunkCount, least_.chunks);
    shrinkRoom(room_.nodes, view_.nodeCount, least_.nodes);
    shrinkRoom(room_.branches, view_.branchCount, least_.branches);
    shrinkRoom(room_.leaves, view_.leafCount, least_.leaves);
    shrinkRoom(room_.items, widest_, least_.items);
    (void)shrink();  // where there isn't memory even for less, all stays where it is
    const Plants& plants = plants_.drawn();
    const Links& links = links_.drawn();
    const AgainBytes again = againBytes(links);
    const struct {
        Buffer* buffer;
        uint64_t bytes;
    } rows[] = {{&items_[0], room_.items * sizeof(WorkItem)},
                {&items_[1], room_.items * sizeof(WorkItem)},
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
                {&leavesWent_, view_.moved.leaves ? leavesWent_.size() : 0},
                {&avoidHeads_, 0},
                {&avoidEntries_, 0},
                {&avoidBounds_, 0}};
    room_.avoid = least_.avoid;
    room_.rounds = least_.rounds;
    room_.grid = least_.grid;
    for (const auto& row : rows)
        if (row.buffer->size() > row.bytes) *row.buffer = {};
    runner_.trim(laneBytes());
    chained_ = chained_ && firstLeaves_ && nextLeaves_;
    stats_.reservedBytes = reserved();
}

Growth::Origin Growth::originOf(const GrowthInputs& inputs) {
    Origin origin;
    origin.seeds.assign(inputs.seeds.begin(), inputs.seeds.end());
    origin.frozen.assign(inputs.frozen.begin(), inputs.frozen.end());
    origin.pruned.assign(inputs.pruned.begin(), inputs.pruned.end());
    origin.widths.assign(inputs.widths.begin(), inputs.widths.end());
    origin.avoids = reachOf(inputs) > 0;
    origin.limits = inputs.limits;
    origin.maps.assign(inputs.grammars.begin(), inputs.grammars.end());
    return origin;
}

Result<std::unique_ptr<Growth>> Growth::create(Device& device, const GrowthRoom& room) {
    return std::unique_ptr<Growth>(new Growth(device, room));
}

}  // namespace espalier
