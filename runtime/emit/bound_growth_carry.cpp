// Enters: bound growth, and where growth has moved its nodes and leaves since, if it has. Leaves: the same bound growth
// by the numbers that growth's records have now, in an order of items with new room. Native code moves it in place
// on software devices; kernels copy it to other buffers, which have new room, too. Binding all anew would cost ten
// times.
#include "runtime/emit/bound_growth.hpp"
#include "runtime/emit/emit_memory.hpp"
#include "runtime/run/emission.hpp"

namespace espalier {

// Whether cells that outgrow their room may soon find none.
bool BoundGrowth::nearlyCrowded(const EmitState& counted) const {
    const uint64_t room = held_.order.size() / 4;
    return counted.ordered > room - room / 8;
}

Status BoundGrowth::makeCarrying(bool moved) {
    Carrying& c = carrying_[moved];
    if (c.cells) return Done{};
    const ProgramOptions options{
        .constants = {{kConstantMoved, moved ? 1u : 0u}, {kConstantLanes, device_->info().traits.cellLanes}}};
    return makeCompute(*device_, {{c.spans, "emit/carry_spans.comp", options},
                                  {c.leaves, "emit/carry_leaves.comp", options},
                                  {c.cells, "emit/carry_cells.comp", options}});
}

// all: instances too, and not the order alone.
Status BoundGrowth::carryByKernels(Commands& commands, const CarryPush& push, bool all) {
    const bool moved = IS_GIVEN(push.nodesWent);
    if (Status s = makeCarrying(moved); !s) return s;
    Pass pass(commands, "bind");
    commands.barrier(Use::compute | Use::vertex, Use::transfer | Use::compute);
    commands.fill(cells_, 0, kAllCells * sizeof(EmitCell) + offsetof(EmitCell, count), sizeof(uint32_t));
    commands.barrier(Use::transfer, Use::compute);
    const Carrying& programs = carrying_[moved];
    if (all) {
        pass.dispatchItems(programs.spans, push.nodeCount, push, {held_.spanTexels});
        pass.dispatchItems(programs.leaves, push.leafCount, push, {held_.leafTexels});
    }
    pass.dispatchItems(programs.cells, kAllCells * device_->info().traits.cellLanes, push);
    pass.barrier(Use::compute, Use::compute | Use::transfer);
    return Done{};
}

Status BoundGrowth::carry(Commands& commands, const EmitInputs& inputs, uint32_t leaves, Source& source) {
    const GrowthView& growth = inputs.growth;
    const bool moved = source.number < growth.renewed;
    const bool fits = held_.fits(growth.nodeCount, leaves);
    const bool native = fits && runsAtOnce(*device_, inputs.native, cells_) && device_->finished(usedBy_);
    const bool stays = fits && (!moved || native);
    Held other;
    if (!stays) {
        if (Status made = assign(other, makeHeld(growth, leaves)); !made) return made.failure();
    }
    const Held& to = stays ? held_ : other;
    if (Status s = makeOrder(spareOrder_, to); !s) return s;

    CarryPush push{};
    if (moved) {
        push.nodesWent = addressOf<UintBuf>(*growth.moved.nodes);
        push.leavesWent = addressOf<UintBuf>(*growth.moved.leaves);
    }
    push.cells = addressOf<EmitCellBuf>(cells_);
    push.order = addressOf<UintBuf>(held_.order);
    push.orderTo = addressOf<UintBuf>(spareOrder_);
    push.keys = addressOf<UintBuf>(held_.keys);
    push.keysTo = addressOf<UintBuf>(to.keys);
    push.leafHeads = addressOf<UintBuf>(held_.leafHeads);
    push.leafHeadsTo = addressOf<UintBuf>(to.leafHeads);
    push.leafNext = addressOf<UintBuf>(held_.leafNext);
    push.leafNextTo = addressOf<UintBuf>(to.leafNext);
    push.spansTo = addressOf<SpanInstanceBuf>(to.spans);
    push.leavesTo = addressOf<LeafInstanceBuf>(to.leaves);
    push.nodeCount = source.nodeCount;
    push.leafCount = source.leafCount;
    push.leafBase = held_.leafBase;
    push.leafBaseTo = to.leafBase;
    if (native) {
        carryNative(push);
    } else {
        if (Status s = carryByKernels(commands, push, !stays); !s) return s;
        usedBy_ = commands.serial();
    }

    std::swap(held_.order, spareOrder_);
    if (!stays) {
        other.order = std::move(held_.order);
        hold(std::move(other));
    }
    if (moved) {
        source.number = growth.renewed;
        source.nodeCount = growth.moved.nodesAfter;
        source.leafCount = growth.moved.leavesAfter;
    }
    ++carries_;
    return Done{};
}

}  // namespace espalier
