// Enters: growth's records. Leaves: an instance in the world for each span and leaf, and the order of items by cells of
// space, each cell's by their order of going when they are thinned out. Runs when growth has changed.
#include <algorithm>
#include <cmath>

#include "runtime/emit/emit.hpp"

namespace espalier {
namespace {

// At most so many leaves; beyond, they are counted as overflow and left out. Nodes are limited by growth.
constexpr uint32_t kMostLeaves = 6'000'000;

// The cubes that fill the box, at most kMaxCells of them.
EmitGrid gridOver(glm::vec3 low, glm::vec3 high) {
    const glm::vec3 extent = glm::max(high - low, glm::vec3(1e-3f * std::max(1e-3f, glm::length(high - low))));
    float cell = std::cbrt(extent.x * extent.y * extent.z / float(kMaxCells));
    EmitGrid grid{};
    for (uint64_t cells = kMaxCells + 1; cells > kMaxCells; cell *= 1.03f) {
        cells = 1;
        for (int axis = 0; axis < 3; ++axis) {
            grid.size[axis] = uint32_t(std::clamp(std::ceil(extent[axis] / cell), 1.0f, float(kMaxCells)));
            cells *= grid.size[axis];
        }
        grid.rcpCell = 1 / cell;
    }
    grid.low = low;
    return grid;
}

}  // namespace

// Items lie in blocks of their cells, of which the last may be half empty.
Status Emit::reserve(uint32_t nodes, uint32_t leaves) {
    const uint64_t items = uint64_t(nodes) + leaves, blocks = items / kBlockItems + 2 * kMaxCells;
    struct Row {
        Buffer& buffer;
        const char* name;
        uint64_t bytes;
        TexelView* texels = nullptr;
    } rows[] = {{spans_, "span instances", nodes * sizeof(SpanInstance), &spanTexels_},
                {leaves_, "leaf instances", leaves * sizeof(LeafInstance), &leafTexels_},
                {keys_, "emit keys", items * 4},
                {order_, "emit order", items * 4},
                {blocks_, "emit blocks", blocks * sizeof(EmitBlock)},
                {rows_, "emit rows", blocks * kMaxBuckets * 4},
                {notes_, "emit notes", blocks * kBlockItems * sizeof(DrawnItem), &noteTexels_},
                {drawn_, "drawn instances", items * sizeof(DrawnItem), &drawnTexels_}};
    for (Row& row : rows) {
        if (row.buffer && row.buffer.size() >= row.bytes) continue;
        if (row.texels) *row.texels = {};
        const uint64_t bytes = std::max<uint64_t>(row.bytes + row.bytes / 4, 65536) / 16 * 16;
        Result<Buffer> made = Buffer::create(*device_, row.name, bytes);
        if (!made) return made.failure();
        row.buffer = std::move(*made);
        bound_ = {};
        if (!row.texels) continue;
        Result<TexelView> view = TexelView::create(*device_, row.buffer, VK_FORMAT_R32G32B32A32_UINT);
        if (!view) return view.failure();
        *row.texels = std::move(*view);
    }
    return Done{};
}

// Records as texels, which software devices read faster than by address.
Status Emit::viewRecords(const GrowthView& growth) {
    const struct {
        TexelView& view;
        const Buffer* buffer;
    } rows[] = {
        {nodeRecords_, growth.nodeBuffer}, {chunkRecords_, growth.chunkBuffer}, {leafRecords_, growth.leafBuffer}};
    const uint64_t most = 16ull * device_->info().limits.maxTexelBufferElements;
    fetches_ = device_->info().cpu;
    for (const auto& row : rows)
        fetches_ = fetches_ && row.buffer && row.buffer->size() >= 16 && row.buffer->size() <= most;
    for (const auto& row : rows) {
        row.view = {};
        const Buffer& buffer = fetches_ ? *row.buffer : noTexels_;
        Result<TexelView> made = TexelView::create(*device_, buffer, VK_FORMAT_R32G32B32A32_UINT);
        if (!made) return made.failure();
        row.view = std::move(*made);
    }
    return Done{};
}

Status Emit::bind(Commands& commands, const EmitInputs& inputs) {
    const GrowthView& growth = inputs.growth;
    const uint32_t nodes = growth.nodeCount, leaves = std::min(growth.leafCount, kMostLeaves);
    if (Status s = reserve(nodes, leaves); !s) return s;
    const Bound wanted{uint64_t(growth.nodes.v),
                       uint64_t(growth.leaves.v),
                       uint64_t(inputs.surfaces.v),
                       inputs.surfacesRevision,
                       growth.revision,
                       nodes,
                       leaves,
                       inputs.low,
                       inputs.high};
    if (wanted == bound_) return Done{};
    bound_ = culled_ = {};
    if (Status s = viewRecords(growth); !s) return s;
    grid_ = gridOver(inputs.low, inputs.high);
    overflow_ = growth.leafCount - leaves;

    BindPush push{};
    push.nodes = growth.nodes;
    push.chunks = growth.chunks;
    push.leaves = growth.leaves;
    push.surfaces = inputs.surfaces;
    push.spans.v = reinterpret_cast<SpanInstance*>(spans_.address());
    push.leafInstances.v = reinterpret_cast<LeafInstance*>(leaves_.address());
    push.cells.v = reinterpret_cast<EmitCell*>(cells_.address());
    push.bins.v = reinterpret_cast<uint32_t*>(bins_.address());
    push.keys.v = reinterpret_cast<uint32_t*>(keys_.address());
    push.order.v = reinterpret_cast<uint32_t*>(order_.address());
    push.grid = grid_;
    push.nodeCount = nodes;
    push.leafCount = leaves;

    const Buffer& table = terminals_->tableBuffer();
    Pass pass(commands, "bind");
    commands.barrier(Use::compute | Use::vertex, Use::transfer | Use::compute);
    commands.fill(cells_, 0);
    commands.fill(bins_, 0);
    commands.barrier(Use::transfer, Use::compute);
    // The lookup knows branches too, which nobody asks for here.
    pass.dispatchItems(bindSpans_[fetches_], nodes, push, {table, nodeRecords_, chunkRecords_, chunkRecords_});
    pass.barrier(Use::compute, Use::compute);
    pass.dispatchItems(bindLeaves_[fetches_], leaves, push, {table, leafRecords_, spanTexels_});
    pass.barrier(Use::compute, Use::compute);
    pass.dispatchItems(bindCells_, 2 * kMaxCells, push);
    pass.barrier(Use::compute, Use::compute);
    pass.dispatchItems(bindOrder_, nodes + leaves, push);
    pass.barrier(Use::compute, Use::compute);
    pass.dispatchItems(bindSort_, 2 * kMaxCells * kCellBins, push, {spanTexels_, leafTexels_});
    pass.barrier(Use::compute, Use::compute | Use::vertex);
    bound_ = wanted;
    return Done{};
}

}  // namespace espalier
