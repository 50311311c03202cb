// In: growth's inputs with pointers for addresses. Out: the same records as the GPU's, in the order in which items were
// pushed. Running out of room is answered as on the GPU.
#include "runtime/expand/cpu_growth.hpp"

#include <algorithm>
#include <map>

#include "runtime/expand/growth_plan.hpp"
#include "runtime/expand/growth_stages.hpp"
#include "runtime/expand/seed_changes.hpp"
#include "runtime/run/host_runner.hpp"

namespace espalier {
namespace {

struct Attempt {
    CpuGrowth out;
    GrowStatus status;
    std::vector<Wave> waves;
};

Attempt attempt(const GrowthInputs& inputs, const GrowthRoom& room, const GrowthCut& cut, const March& march) {
    Attempt a;
    a.out.nodes.resize(room.nodes);
    a.out.chunks.resize(room.chunks);
    a.out.branches.resize(room.branches);
    a.out.leaves.resize(room.leaves);
    a.status = freshStatus(inputs, room, cut);
    std::vector<uint32_t> pruned = keyWords(inputs.pruned);
    a.status.pruned = {pruned.data()};
    a.status.prunedCount = uint32_t(inputs.pruned.size());
    const bool avoids = a.status.avoidReach > 0;
    std::vector<uint32_t> cells(avoids ? a.status.avoidCells : 0, kNoIndex), entries(2 * size_t(room.avoid)),
        bounds(avoids ? room.chunks : 0);
    a.status.avoidHeads = {cells.data()};
    a.status.avoidEntries = {entries.data()};
    a.status.avoidBounds = {bounds.data()};
    a.waves = wavesOfSeeds(uint32_t(inputs.seeds.size()), inputs.limits, room);
    std::vector<RuleMapRef> grammars(inputs.grammars.begin(), inputs.grammars.end());
    uint64_t words = 0;
    std::vector<GrammarTables> heads = placeTables(inputs, words);
    std::vector<uint32_t> tables(words + 1);
    std::memcpy(tables.data(), heads.data(), heads.size() * sizeof(GrammarTables));

    ExpandEnv env{};
    env.surfaces = inputs.surfaces;
    env.layers = inputs.layers;
    env.grammars = {grammars.data()};
    env.tables = {tables.data()};
    env.nodes = {a.out.nodes.data()};
    env.chunks = {a.out.chunks.data()};
    env.branches = {a.out.branches.data()};
    env.leaves = {a.out.leaves.data()};
    env.status = {&a.status};
    env.waves = {a.waves.data()};
    env.itemCapacity = room.items;
    env.phase = lastWave(cut);
    std::vector<WorkItem> even = itemsOfSeeds(inputs.seeds), odd(room.items);
    even.resize(room.items);
    const bool sums = inputs.limits.leafDensityCap > 0 || inputs.limits.tangents == TangentMode::paper;
    std::vector<uint32_t> density(sums ? kDensityCells + 3 * size_t(room.nodes) : 0);
    env.density = {density.data()};
    HostRunner plainly(1, true);
    StageList packing = tableStages({}, env, uint32_t(grammars.size()));
    plainly.run(packing);
    const ItemQueues queues = {{{even.data()}, {odd.data()}}};
    const uint32_t most = uint32_t(a.waves.size()) - 1, marched = march ? march(env, queues, most) : 0;
    StageList growth =
        growthStages({}, env, queues, inputs.limits, avoids ? room.rounds : 0, marched, march ? marched : most);
    plainly.run(growth);
    a.waves.resize(wavesOf(a.waves) + 1);
    return a;
}

// A growth's branches by key, as their nodes in order.
std::multimap<uint64_t, uint32_t> branchesByKey(const GrowthRecords& g) {
    std::multimap<uint64_t, uint32_t> keys;
    for (uint32_t i = 0; i < g.branches.size(); ++i) keys.emplace(g.chunks[g.branches[i].firstChunk].key, i);
    return keys;
}
std::vector<Node> nodesOfBranch(const GrowthRecords& g, uint32_t branch) {
    std::vector<Node> nodes;
    for (uint32_t c = g.branches[branch].firstChunk; c != kNoIndex; c = g.chunks[c].next) {
        const Chunk& chunk = g.chunks[c];
        for (uint32_t i = 0; i < chunkNodes(chunk.marks); ++i) nodes.push_back(g.nodes[chunk.firstNode + i]);
    }
    return nodes;
}

std::string decisionAt(const std::vector<Node>& a, const std::vector<Node>& b, float& farthest) {
    size_t n = std::min(a.size(), b.size());
    for (size_t i = 0; i < n; ++i) {
        const Node &x = a[i], &y = b[i];
        farthest = std::max(farthest, glm::length(x.position - y.position));
        std::string at = "node " + std::to_string(i) + ": ";
        if (x.place != y.place) return at + "charts " + std::to_string(x.place) + " and " + std::to_string(y.place);
        if ((x.flags ^ y.flags) & kNodeInserted) return at + "only one has a sample here";
        if (x.position != y.position || x.arc != y.arc) return at + "positions";
        if (x.tangent != y.tangent || x.normal != y.normal || x.uv != y.uv) return at + "frames";
        if (x.radius != y.radius) return at + "radii";
        if (x.flags != y.flags) return at + "flags";
    }
    return a.size() == b.size() ? "" : std::to_string(a.size()) + " and " + std::to_string(b.size()) + " nodes";
}

}  // namespace

Result<CpuGrowth> growOnCpu(const GrowthInputs& inputs, GrowthRoom room, const March& march) {
    Status usable = checkInputs(inputs);
    if (!usable) return usable.failure();
    room.items = std::max(room.items, uint32_t(inputs.seeds.size()));
    if (reachOf(inputs) > 0) room.avoid = std::max(room.avoid, 2 * room.nodes);
    GrowthCut cut = noCut(inputs.limits);
    uint32_t overflow = 0, enlarged = 0;
    Verdict verdict = Verdict::impossible;
    while (overflow + enlarged < 48) {
        Attempt a = attempt(inputs, room, cut, march);
        verdict = judge(a.status, a.waves, inputs.limits, room, cut);
        if (verdict == Verdict::impossible || verdict == Verdict::tooManyLeaves) break;
        if (verdict != Verdict::complete) {
            (verdict == Verdict::cut ? overflow : enlarged) += 1;
            continue;
        }
        CpuGrowth& out = a.out;
        out.nodes.resize(a.status.nodes);
        out.chunks.resize(a.status.chunks);
        out.branches.resize(a.status.branches);
        out.leaves.resize(a.status.leaves);
        out.stats.seeds = uint32_t(inputs.seeds.size());
        takeCounters(a.status, out.stats);
        out.stats.waves = uint32_t(a.waves.size()) - 1;
        out.stats.overflow = overflow;
        out.stats.enlarged = enlarged;
        out.stats.expansions = 1;
        compactRecords(out);
        return std::move(a.out);
    }
    return limitFailure(verdict, inputs.limits);
}

GrowthDifference compareGrowth(const GrowthRecords& a, const GrowthRecords& b) {
    constexpr size_t kMostNotes = 16;
    GrowthDifference difference;
    std::multimap<uint64_t, uint32_t> left = branchesByKey(a), right = branchesByKey(b);
    for (auto [key, branch] : left) {
        difference.branches += 1;
        auto found = right.find(key);
        std::string note = "is missing in the second";
        if (found != right.end()) {
            note = decisionAt(nodesOfBranch(a, branch), nodesOfBranch(b, found->second), difference.farthest);
            right.erase(found);
        }
        if (note.empty()) {
            difference.alike += 1;
        } else if (difference.notes.size() < kMostNotes) {
            difference.notes.push_back("branch " + std::to_string(key) + ": " + note);
        }
    }
    difference.branches += uint32_t(right.size());
    if (!right.empty()) difference.notes.push_back(std::to_string(right.size()) + " branches only in the second");
    return difference;
}

}  // namespace espalier
