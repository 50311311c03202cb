// Enters: bound growth, and where growth has moved its nodes and leaves since, if it has. Leaves: the same bound growth
// in buffers with new room, by the numbers that growth's records have now. A copy: what binding all anew would cost ten
// times.
#include "runtime/emit/emit.hpp"

namespace espalier {
namespace {

UintBuf words(const Buffer& buffer) {
    return {reinterpret_cast<uint32_t*>(buffer.address())};
}

}  // namespace

// Whether cells that outgrow their room may soon find none.
bool Emit::nearlyCrowded() const {
    const uint64_t room = held_.order.size() / 4;
    return reinterpret_cast<const EmitState*>(readback_.mapped())->ordered > room - room / 8;
}

Status Emit::makeCarrying(bool moved) {
    Carrying& c = carrying_[moved];
    if (c.cells) return Done{};
    const struct {
        Program& program;
        const char* shader;
    } rows[] = {
        {c.spans, "emit/carry_spans.comp"}, {c.leaves, "emit/carry_leaves.comp"}, {c.cells, "emit/carry_cells.comp"}};
    for (const auto& row : rows) {
        Result<Program> made = Program::compute(*device_, row.shader, {.constants = {{4, moved ? 1u : 0u}}});
        if (!made) return made.failure();
        row.program = std::move(*made);
    }
    return Done{};
}

Status Emit::carry(Commands& commands, const GrowthView& growth, uint32_t leaves, Bound& bound) {
    const bool moved = bound.number < growth.renewed;
    const GrowthMove& move = growth.moved;
    if (Status s = makeCarrying(moved); !s) return s;
    Result<Held> to = makeHeld(growth, leaves);
    if (!to) return to.failure();

    CarryPush push{};
    if (moved) {
        push.nodesWent = words(*move.nodes);
        push.leavesWent = words(*move.leaves);
    }
    push.cells.v = reinterpret_cast<EmitCell*>(cells_.address());
    push.order = words(held_.order);
    push.orderTo = words(to->order);
    push.keys = words(held_.keys);
    push.keysTo = words(to->keys);
    push.leafHeads = words(held_.leafHeads);
    push.leafHeadsTo = words(to->leafHeads);
    push.leafNext = words(held_.leafNext);
    push.leafNextTo = words(to->leafNext);
    push.spansTo.v = reinterpret_cast<SpanInstance*>(to->spans.address());
    push.leavesTo.v = reinterpret_cast<LeafInstance*>(to->leaves.address());
    push.nodeCount = bound.nodeCount;
    push.leafCount = bound.leafCount;
    push.leafBase = held_.leafBase;
    push.leafBaseTo = to->leafBase;

    Pass pass(commands, "bind");
    commands.barrier(Use::compute | Use::vertex, Use::transfer | Use::compute);
    commands.fill(cells_, 0, kAllCells * sizeof(EmitCell) + offsetof(EmitCell, count), sizeof(uint32_t));
    commands.barrier(Use::transfer, Use::compute);
    const Carrying& programs = carrying_[moved];
    pass.dispatchItems(programs.spans, bound.nodeCount, push, {held_.spanTexels});
    pass.dispatchItems(programs.leaves, bound.leafCount, push, {held_.leafTexels});
    pass.dispatchItems(programs.cells, kAllCells, push);
    pass.barrier(Use::compute, Use::compute | Use::transfer);
    hold(std::move(*to));
    reinterpret_cast<EmitState*>(readback_.mapped())->ordered = 0;  // until the next count comes back
    if (moved) {
        bound.number = growth.renewed;
        bound.nodeCount = move.nodesAfter;
        bound.leafCount = move.leavesAfter;
    }
    ++carries_;
    return Done{};
}

}  // namespace espalier
