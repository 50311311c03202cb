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

Status GpuGrowth::compact() {
    Plants& plants = plants_[1 - frontPlants_];
    Links& links = links_[1 - frontLinks_];
    const Plants& plantsNow = plants_[frontPlants_];
    const Links& linksNow = links_[frontLinks_];
    dropViews();
    const auto roomy = [](uint32_t live, uint32_t room) { return std::max<uint64_t>(live + live / 2ull, room); };
    Status steps[] = {
        load(compactPlaces_, "expand/compact_places.comp", {}),
        load(compactNodes_, "expand/compact_nodes.comp", {}),
        load(compactLeaves_, "expand/compact_leaves.comp", {}),
        ensure(plants.nodes, "growth nodes", wholeTexels(roomy(stats_.nodes, room_.nodes) * sizeof(Node))),
        ensure(plants.leaves, "growth leaves", roomy(stats_.leaves, room_.leaves) * sizeof(Leaf)),
        ensure(links.chunks, "growth chunks",
               std::max<uint64_t>(linksNow.chunks.size(), room_.chunks * uint64_t(sizeof(Chunk)))),
        ensure(links.branches, "growth branches",
               std::max<uint64_t>(linksNow.branches.size(), room_.branches * uint64_t(sizeof(BranchRecord))))};
    for (Status& step : steps)
        if (!step) return step;

    Result<Commands> commands = Commands::begin(device_, "close gaps");
    if (!commands) return commands.failure();
    if (Status up = commands->upload(status_, std::vector<GrowStatus>(1)); !up) return up;
    commands->copy(linksNow.chunks, links.chunks, view_.chunkCount * sizeof(Chunk));
    commands->copy(linksNow.branches, links.branches, view_.branchCount * sizeof(BranchRecord));
    commands->barrier(Use::transfer, Use::compute);
    CompactEnv env{};
    env.nodes = addressOf<NodeBuf, Node>(plantsNow.nodes);
    env.toNodes = addressOf<NodeBuf, Node>(plants.nodes);
    env.leaves = addressOf<LeafBuf, Leaf>(plantsNow.leaves);
    env.toLeaves = addressOf<LeafBuf, Leaf>(plants.leaves);
    env.chunks = addressOf<ChunkBuf, Chunk>(linksNow.chunks);
    env.toChunks = addressOf<ChunkBuf, Chunk>(links.chunks);
    env.status = addressOf<GrowStatusBuf, GrowStatus>(status_);
    env.chunkCount = view_.chunkCount;
    env.leafCount = view_.leafCount;
    {
        Pass pass(*commands, "expand compact");
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
    GrowStatus status;
    std::memcpy(&status, readback_.mapped(), sizeof status);
    requireEqual(status.nodes, stats_.nodes, "nodes that stay when gaps are closed");
    requireEqual(status.leaves, stats_.leaves, "leaves that stay when gaps are closed");
    status.chunks = view_.chunkCount;
    status.branches = view_.branchCount;
    frontPlants_ = 1 - frontPlants_;
    chained_ = false;
    showLinks(status, true);
    stats_.reservedBytes = reserved();
    return Done{};
}

}  // namespace espalier
