// Enters: what is to be bound, growth or what an edit has touched of it. Leaves: the kernels' passes that bind it.
#include "runtime/emit/bound_growth.hpp"

#include <algorithm>
#include <cstddef>

#include "runtime/emit/cell_lanes.hpp"

namespace espalier {

// Records as texels, which software devices read faster than by address.
Status BoundGrowth::viewRecords(const GrowthView& growth, uint32_t nodesBefore) {
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
        if (Status made = assign(row.view, TexelView::create(*device_, buffer, VK_FORMAT_R32G32B32A32_UINT)); !made)
            return made.failure();
    }
    // Four numbers a texel.
    const Buffer* touched = growth.touched;
    fetchesTouched_ = fetches_ && touched && touched->size() / 16 * 4 >= nodesBefore && touched->size() <= most;
    touchedRecords_ = {};
    Result<TexelView> made =
        TexelView::create(*device_, fetchesTouched_ ? *touched : noTexels_, VK_FORMAT_R32G32B32A32_UINT);
    if (!made) return made.failure();
    touchedRecords_ = std::move(*made);
    return Done{};
}

Status BoundGrowth::bindByKernels(Commands& commands, const GrowthView& growth, const TileWatch& watch,
                                  const BindInputs& given) {
    if (Status s = viewRecords(growth, given.nodesBefore); !s) return s;
    const Buffer& in = inputs_[inputSlot_++ % inputs_.size()];
    Pass pass(commands, "bind");
    commands.barrier(Use::compute | Use::vertex, Use::transfer | Use::compute);
    if (Status s = commands.upload(in, std::as_bytes(std::span(&given, 1))); !s) return s;
    if (given.partly != 0) {
        commands.fill(flags_, 0, 0, std::max(given.nodeCount, given.nodesBefore) * 4ull);
        commands.fill(cells_, 0, kAllCells * sizeof(EmitCell) + offsetof(EmitCell, changed),
                      sizeof(EmitCell) - offsetof(EmitCell, changed));
    } else {
        commands.fill(cells_, 0);
        commands.fill(bins_, 0);
    }
    commands.barrier(Use::transfer, Use::compute);
    dispatchBinding(pass, watch, given, in);
    return Done{};
}

void BoundGrowth::dispatchBinding(Pass& pass, const TileWatch& watch, const BindInputs& given, const Buffer& in) {
    const bool partly = given.partly != 0;
    const uint32_t nodes = given.nodeCount, leaves = given.leafCount;
    const Buffer& table = terminals_->tableBuffer();
    if (partly) {
        pass.dispatchItems(bindTouch_[fetchesTouched_], std::max(nodes / 4 + 1, kAllCells), {}, {touchedRecords_, in});
        pass.barrier(Use::compute, Use::compute);
    }
    // Kernels go through what there is to do in strides: how much that is, a part's are the first to know.
    const auto groupsFor = [&](uint32_t items) {
        return std::array<uint32_t, 3>{partly ? 64u : std::min(items / 64 + 1, 65535u), 1, 1};
    };
    // The lookup knows branches too, which nobody asks for here.
    pass.dispatch(bindSpans_[fetches_], groupsFor(nodes), {},
                  {table, nodeRecords_, chunkRecords_, chunkRecords_, watch.record(), in});
    pass.barrier(Use::compute, Use::compute);
    pass.dispatch(bindStretches_, groupsFor(nodes), {}, {table, held_.spanTexels, in});
    pass.barrier(Use::compute, Use::compute);
    pass.dispatch(bindLeaves_[fetches_], groupsFor(leaves), {},
                  {table, leafRecords_, held_.spanTexels, watch.record(), in});
    pass.barrier(Use::compute, Use::compute);
    if (partly) {
        pass.dispatchItems(bindKeep_, kAllCells * cellLanes(*device_), {}, {in});
        pass.barrier(Use::compute, Use::compute);
    }
    const std::array<uint32_t, 3> groups = groupsFor(std::min(nodes + leaves, 4095u * 64));
    pass.dispatch(bindCount_, groups, {}, {table, held_.spanTexels, held_.leafTexels, in});
    pass.barrier(Use::compute, Use::compute);
    pass.dispatchItems(bindCells_, kAllCells + 1, {}, {in});
    pass.barrier(Use::compute, Use::compute);
    pass.dispatch(bindOrder_, groups, {}, {in});
    pass.barrier(Use::compute, Use::compute);
    pass.dispatchItems(bindSort_, kAllCells * sortLanes(*device_), {}, {held_.spanTexels, held_.leafTexels, in});
    pass.barrier(Use::compute, Use::compute | Use::vertex);
}

}  // namespace espalier
