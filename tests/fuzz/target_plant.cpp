// In: bytes. Out: nothing, if all goes well; a plant that is accepted packs to as many bytes, which say the same, and
// can be grown on: another one beside it can be taken out, the gaps be closed, and what is left be bound for drawing.
#include <algorithm>
#include <cstring>
#include <vector>

#include "runtime/core/hash.hpp"
#include "runtime/expand/frozen.hpp"
#include "runtime/expand/growth_plan.hpp"
#include "runtime/host/bind.hpp"
#include "runtime/host/kernels.hpp"
#include "shaders/expand/compact.h"
#include "tests/fuzz/promise.hpp"

namespace espalier::fuzz {
namespace {

constexpr size_t kCountsAt = 8, kHashAt = 24, kHead = 32;
constexpr uint32_t kSurfaces = 3;

// The same with counts that fit its size and the hash that belongs to it: nearly every change would else be refused
// for these alone.
std::vector<std::byte> repaired(std::span<const std::byte> bytes) {
    std::vector<std::byte> out(bytes.begin(), bytes.end());
    const size_t sizes[] = {sizeof(Node), sizeof(Chunk), sizeof(BranchRecord), sizeof(Leaf)};
    size_t used = kHead;
    for (size_t i = 0; i < 4; ++i) {
        uint32_t count = 0;
        std::memcpy(&count, out.data() + kCountsAt + 4 * i, sizeof count);
        count = uint32_t(std::min<size_t>(count, (out.size() - used) / sizes[i]));
        std::memcpy(out.data() + kCountsAt + 4 * i, &count, sizeof count);
        used += count * sizes[i];
    }
    out.resize(used);
    const uint64_t hash = hashBytes(std::span(out).subspan(kHead));
    std::memcpy(out.data() + kHashAt, &hash, sizeof hash);
    return out;
}

// The first of two plants goes, as an edit takes it out.
void takeFirst(GrowthRecords& both, const PlantRecords& first) {
    for (size_t i = 0; i < first.nodes.size(); ++i) {
        both.nodes[i].flags &= 0x1F00u;
        both.nodes[i].radius = -1;
    }
    for (size_t i = 0; i < first.chunks.size(); ++i) both.chunks[i].marks = 0;
    for (size_t i = 0; i < first.branches.size(); ++i) both.branches[i].firstChunk = kNoIndex;
    for (size_t i = 0; i < first.leaves.size(); ++i) both.leaves[i].node = kNoIndex;
}

void closeGaps(GrowthRecords& records) {
    std::vector<uint32_t> nodesWent(records.nodes.size()), leavesWent(records.leaves.size());
    GrowStatus now{};
    CompactEnv env{};
    env.nodes = env.toNodes = {records.nodes.data()};
    env.leaves = env.toLeaves = {records.leaves.data()};
    env.chunks = env.toChunks = {records.chunks.data()};
    env.nodesWent = {nodesWent.data()};
    env.leavesWent = {leavesWent.data()};
    env.status = {&now};
    env.chunkCount = uint32_t(records.chunks.size());
    env.nodeCount = uint32_t(records.nodes.size());
    env.leafCount = uint32_t(records.leaves.size());
    Crew crew(1);
    hostKernel("expand/close_gaps")(&env, {crew});
    records.nodes.resize(now.nodes);
    records.leaves.resize(now.leaves);
}

// With a kind of bark and one of leaves.
void bind(GrowthRecords& records) {
    std::vector<SurfaceRef> surfaces(kSurfaces);
    for (SurfaceRef& surface : surfaces)
        for (int i = 0; i < 3; ++i) surface.toWorld[i][i] = 1;
    EmitTable table{};
    table.kinds[0] = {0, 1, 1, 0};
    table.kinds[1] = {1, 1, 0, 0};
    table.kindCount = table.variantCount = table.bucketCount = 2;
    for (uint32_t i = 0; i < 2; ++i) table.variants[i] = {i, 1, 1, {}, {}};
    const size_t nodes = records.nodes.size(), leaves = records.leaves.size(), items = nodes + leaves;
    std::vector<SpanInstance> spans(nodes);
    std::vector<LeafInstance> leafInstances(leaves);
    std::vector<EmitCell> cells(kAllCells + 1);
    std::vector<uint32_t> bins(size_t(kAllCells) * kCellBins), keys(items), list(items), leafHeads(nodes),
        leafNext(leaves), order(20 * items);
    BindInputs push{};
    push.nodes = {records.nodes.data()};
    push.chunks = {records.chunks.data()};
    push.leaves = {records.leaves.data()};
    push.surfaces = {surfaces.data()};
    push.spans = {spans.data()};
    push.leafInstances = {leafInstances.data()};
    push.cells = {cells.data()};
    push.bins = {bins.data()};
    push.keys = {keys.data()};
    push.order = {order.data()};
    push.list = {list.data()};
    push.leafHeads = {leafHeads.data()};
    push.leafNext = {leafNext.data()};
    push.grid = {{-8, -8, -8}, 1, {16, 16, 16}};
    push.nodeCount = push.leafBase = uint32_t(nodes);
    push.leafCount = uint32_t(leaves);
    push.orderRoom = uint32_t(order.size());
    bindNative(push, table, EmitView{}, 1);
}

void check(std::span<const std::byte> bytes) {
    auto plant = unpackPlant(bytes, kSurfaces);
    if (!plant) return checkMessage(plant.failure());
    // Files of before hold read sets, which are left out.
    const std::vector<std::byte> packed = packPlant(*plant);
    auto again = unpackPlant(packed, kSurfaces);
    require(packed.size() == bytes.size() && again && packPlant(*again) == packed, "a plant packs to what it was");
    const auto records = std::make_shared<const PlantRecords>(std::move(*plant));
    const FrozenPlant twice[] = {{1, records}, {2, records}};
    GrowthRecords both = sumOf(twice, 5).records;
    require(both.nodes.size() == 2 * records->nodes.size(), "plants stand side by side");
    takeFirst(both, *records);
    GrowthRecords second = both;
    compactRecords(second);
    closeGaps(both);
    for (const GrowthRecords* left : {&both, &second}) {
        require(left->nodes.size() == records->nodes.size(), "the nodes of one are left");
        require(left->leaves.size() == records->leaves.size(), "the leaves of one are left");
    }
    require(second.chunks.size() == records->chunks.size(), "the chunks of one are left");
    require(second.branches.size() == records->branches.size(), "the branches of one are left");
    bind(both);
}

}  // namespace

void plant(Bytes bytes) {
    const auto all = std::as_bytes(bytes);
    check(all);
    if (all.size() >= kHead) check(repaired(all));
}

}  // namespace espalier::fuzz
