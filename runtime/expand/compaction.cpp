// Closing the gaps that edits have left. In: what is drawn. Out: its nodes and leaves without gaps in the other set of
// buffers, which is drawn from then on: a copy where all anew would be ten times the work. Chunks and branches keep
// their places.
#include "runtime/core/check.hpp"
#include "runtime/expand/gpu_growth.hpp"
#include "shaders/expand/compact.h"

namespace espalier {

bool GpuGrowth::gappy() const {
    constexpr uint32_t kMostGapsOf = 3;
    const auto wide = [](uint32_t taken, uint32_t live) { return taken - std::min(taken, live) > taken / kMostGapsOf; };
    return wide(view_.nodeCount, stats_.nodes) || wide(view_.leafCount, stats_.leaves);
}

Status GpuGrowth::makeCompactRoom(bool native) {
    Plants& plants = plants_[1 - frontPlants_];
    Links& links = links_[1 - frontLinks_];
    const Links& linksNow = links_[frontLinks_];
    const auto roomy = [](uint32_t live, uint32_t room) { return std::max<uint64_t>(live + live / 2ull, room); };
    Status steps[] = {
        ensure(plants.nodes, "growth nodes", wholeTexels(roomy(stats_.nodes, room_.nodes) * sizeof(Node))),
        ensure(plants.leaves, "growth leaves", roomy(stats_.leaves, room_.leaves) * sizeof(Leaf)),
        ensure(links.chunks, "growth chunks",
               std::max<uint64_t>(linksNow.chunks.size(), room_.chunks * uint64_t(sizeof(Chunk)))),
        ensure(links.branches, "growth branches",
               std::max<uint64_t>(linksNow.branches.size(), room_.branches * uint64_t(sizeof(BranchRecord)))),
        ensure(nodesWent_, "growth where nodes went", std::max(view_.nodeCount, 1u) * 4ull),
        ensure(leavesWent_, "growth where leaves went", std::max(view_.leafCount, 1u) * 4ull),
        native ? Status(Done{}) : load(compactPlaces_, "expand/compact_places.comp", {}),
        native ? Status(Done{}) : load(compactNodes_, "expand/compact_nodes.comp", {}),
        native ? Status(Done{}) : load(compactLeaves_, "expand/compact_leaves.comp", {})};
    for (Status& step : steps)
        if (!step) return step;
    return Done{};
}

CompactEnv GpuGrowth::compactEnvironment() const {
    CompactEnv env{};
    env.nodes = view_.nodes;
    env.leaves = view_.leaves;
    env.chunks = view_.chunks;
    env.toNodes = addressOf<NodeBuf, Node>(plants_[1 - frontPlants_].nodes);
    env.toLeaves = addressOf<LeafBuf, Leaf>(plants_[1 - frontPlants_].leaves);
    env.toChunks = addressOf<ChunkBuf, Chunk>(links_[1 - frontLinks_].chunks);
    env.nodesWent = addressOf<UintBuf, uint32_t>(nodesWent_);
    env.leavesWent = addressOf<UintBuf, uint32_t>(leavesWent_);
    env.status = addressOf<GrowStatusBuf, GrowStatus>(status_);
    env.chunkCount = view_.chunkCount;
    env.leafCount = view_.leafCount;
    return env;
}

Status GpuGrowth::compact(const GrowthInputs& inputs) {
    const bool native = runsNative(inputs);
    dropViews();
    if (Status room = makeCompactRoom(native); !room) return room;
    const Links &links = links_[1 - frontLinks_], &linksNow = links_[frontLinks_];
    Result<Commands> commands = Commands::begin(device_, "close gaps");
    if (!commands) return commands.failure();
    if (Status up = commands->upload(status_, std::vector<GrowStatus>(1)); !up) return up;
    commands->copy(linksNow.chunks, links.chunks, view_.chunkCount * sizeof(Chunk));
    commands->copy(linksNow.branches, links.branches, view_.branchCount * sizeof(BranchRecord));
    commands->fill(nodesWent_, kNoIndex);
    commands->barrier(Use::transfer, Use::compute);
    if (!native) {
        Pass pass(*commands, "expand compact");
        const CompactEnv env = compactEnvironment();
        const std::array<uint32_t, 3> groups = spreadGroups();
        pass.dispatch(compactPlaces_, groups, env);
        pass.barrier(Use::compute, Use::compute);
        pass.dispatch(compactNodes_, groups, env);
        pass.dispatch(compactLeaves_, groups, env);
        pass.barrier(Use::compute, Use::transfer | Use::compute);
    }
    commands->copy(status_, readback_, sizeof(GrowStatus));
    commands->barrier(Use::transfer, Use::host);
    if (Status finished = commands->finish(); !finished) return finished;
    if (native) compactNative(compactEnvironment(), kAllThreads);
    GrowStatus status;
    std::memcpy(&status, native ? status_.mapped() : readback_.mapped(), sizeof status);
    requireEqual(status.nodes, stats_.nodes, "nodes that stay when gaps are closed");
    requireEqual(status.leaves, stats_.leaves, "leaves that stay when gaps are closed");
    status.chunks = view_.chunkCount;
    status.branches = view_.branchCount;
    const GrowthMove moved{&nodesWent_, &leavesWent_, view_.nodeCount, view_.leafCount, status.nodes, status.leaves};
    frontPlants_ = 1 - frontPlants_;
    chained_ = false;
    showLinks(status, true);
    view_.moved = moved;
    view_.touched = &touched_;  // what it says of earlier growths is of no account any more
    stats_.reservedBytes = reserved();
    return Done{};
}

}  // namespace espalier
