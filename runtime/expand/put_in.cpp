// Frozen plants that come from elsewhere. In: their records, what is drawn. Out: both together. The regrowth that
// follows takes them for plants that have always been there, and away what their seeds had grown instead.
#include <algorithm>
#include <set>

#include "runtime/core/undo.hpp"
#include "runtime/expand/growth.hpp"

namespace espalier {

Result<bool> Growth::putIn(const GrowthInputs& inputs) {
    if (inputs.changes->frozen.empty()) return true;
    const std::set<uint64_t> keys(inputs.changes->frozen.begin(), inputs.changes->frozen.end());
    std::set<std::pair<uint64_t, const PlantRecords*>> standing;
    for (const FrozenPlant& plant : origin_.frozen) standing.emplace(plant.key, plant.records.get());
    std::vector<FrozenPlant> fresh;
    for (const FrozenPlant& plant : inputs.frozen)
        if (keys.contains(plant.key) && !standing.contains({plant.key, plant.records.get()})) fresh.push_back(plant);
    if (fresh.empty()) return true;
    FrozenSum sum = sumOf(fresh, uint32_t(origin_.seeds.size() + origin_.frozen.size()));
    GrowthRecords& r = sum.records;
    // With what their seeds had grown instead these may be too many leaves for a while: growing all anew tells.
    if (stats_.leaves + r.leaves.size() > inputs.limits.maxLeaves) return false;
    shiftRecords(r, view_.nodeCount, view_.chunkCount, view_.branchCount);

    const Plants& plants = plants_.drawn();
    const Links& links = links_.drawn();
    Result<Commands> commands = Commands::begin(device_, "put plants in");
    if (!commands) return commands.failure();
    bool fits = true;
    const auto add = [&](const Buffer& buffer, const auto& records, uint32_t before) -> Status {
        const uint64_t size = sizeof(records[0]), at = before * size;
        if (records.size() * size > buffer.size() - std::min(buffer.size(), at)) fits = false;
        return fits ? commands->upload(buffer, records, at) : Status(Done{});
    };
    if (Status s = allDone({add(plants.nodes, r.nodes, view_.nodeCount), add(plants.leaves, r.leaves, view_.leafCount),
                            add(links.chunks, r.chunks, view_.chunkCount),
                            add(links.branches, r.branches, view_.branchCount)});
        !s)
        return s.failure();
    if (!fits) return false;
    if (Status finished = commands->finish(); !finished) return finished.failure();

    origin_.frozen.insert(origin_.frozen.end(), fresh.begin(), fresh.end());
    view_.nodeCount += uint32_t(r.nodes.size());
    view_.leafCount += uint32_t(r.leaves.size());
    view_.chunkCount += uint32_t(r.chunks.size());
    view_.branchCount += uint32_t(r.branches.size());
    view_.revision += 1;
    chained_ = false;  // what has come isn't
    stats_.nodes += uint32_t(r.nodes.size());
    stats_.leaves += uint32_t(r.leaves.size());
    stats_.chunks += uint32_t(r.chunks.size());
    stats_.branches += uint32_t(r.branches.size());
    stats_.steps += sum.steps;
    stats_.inserted += sum.inserted;
    stats_.stopped += sum.stopped;
    stats_.deadEnds += sum.deadEnds;
    const uvec2 hash = uvec2(uint32_t(stats_.hash), uint32_t(stats_.hash >> 32)) + uvec2(sum.hash[0], sum.hash[1]);
    stats_.hash = uint64_t(hash.y) << 32 | hash.x;
    return true;
}

// Unless the regrowth gets done they are taken out again: they are the last of all records.
Result<Growth::Regrown> Growth::regrowWithFrozen(const GrowthInputs& inputs) {
    Undo takeOut([this, view = view_, stats = stats_, frozen = origin_.frozen.size()] {
        origin_.frozen.resize(frozen);
        view_.nodeCount = view.nodeCount;
        view_.leafCount = view.leafCount;
        view_.chunkCount = view.chunkCount;
        view_.branchCount = view.branchCount;
        view_.revision = view.revision;
        stats_ = stats;
    });
    Result<bool> put = putIn(inputs);
    if (!put) return put.failure();
    const std::optional<SeedChanges> seeds = *put ? seedChanges(origin_, inputs) : std::nullopt;
    if (!seeds) return Regrown::tooMuch;
    Result<Regrown> done = regrow(inputs, *seeds);
    if (done && *done == Regrown::done) takeOut.done();
    return done;
}

}  // namespace espalier
