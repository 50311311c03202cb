// Enters: what is to be bound, growth or what an edit has touched of it. Leaves: the kernels' passes that bind it.
#include "runtime/emit/bound_growth.hpp"

#include <algorithm>
#include <cstddef>

namespace espalier {

Status BoundGrowth::bindByKernels(Commands& commands, const TileWatch& watch, const BindInputs& given) {
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
    const DeviceTraits& traits = device_->info().traits;
    const bool partly = given.partly != 0;
    const uint32_t nodes = given.nodeCount, leaves = given.leafCount;
    const Buffer& table = terminals_->tableBuffer();
    if (partly) {
        pass.dispatchItems(bindTouch_, std::max(nodes / 4 + 1, kAllCells), {}, {in});
        pass.barrier(Use::compute, Use::compute);
    }
    // Kernels go through what there is to do in strides: how much that is, a part's are the first to know.
    const uint32_t most = !partly ? 65535 : given.movedWords > 0 ? 1024 : 64;
    const auto groupsFor = [&](uint32_t items) {
        return std::array<uint32_t, 3>{std::min(items / 64 + 1, most), 1, 1};
    };
    pass.dispatch(bindSpans_, groupsFor(nodes), {}, {table, watch.record(), in});
    pass.barrier(Use::compute, Use::compute);
    pass.dispatch(bindStretches_, groupsFor(nodes), {}, {table, held_.spanTexels, in});
    pass.barrier(Use::compute, Use::compute);
    pass.dispatch(bindLeaves_, groupsFor(leaves), {}, {table, held_.spanTexels, watch.record(), in});
    pass.barrier(Use::compute, Use::compute);
    if (partly) {
        pass.dispatchItems(bindKeep_, kAllCells * traits.cellLanes, {}, {in});
        pass.barrier(Use::compute, Use::compute);
    }
    const std::array<uint32_t, 3> groups = groupsFor(std::min(nodes + leaves, 4095u * 64));
    pass.dispatch(bindCount_, groups, {}, {table, held_.spanTexels, held_.leafTexels, in});
    pass.barrier(Use::compute, Use::compute);
    pass.dispatchItems(bindCells_, kAllCells + 1, {}, {in});
    pass.barrier(Use::compute, Use::compute);
    pass.dispatch(bindOrder_, groups, {}, {in});
    pass.barrier(Use::compute, Use::compute);
    pass.dispatchItems(bindSort_, kAllCells * traits.sortLanes, {}, {held_.spanTexels, held_.leafTexels, in});
    pass.barrier(Use::compute, Use::compute | Use::vertex);
}

}  // namespace espalier
