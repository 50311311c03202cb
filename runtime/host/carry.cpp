// Enters: bound growth and its new numbers, by pointer. Leaves: what the carry_*.comp kernels would, in place.
#include "runtime/host/carry.hpp"

#include <algorithm>
#include <vector>

#include "runtime/core/jobs.hpp"
#include "shaders/emit/cells.h"

namespace espalier {
namespace {

constexpr size_t kCellsAtOnce = 512;

// Of a chain: kNoIndex, where it ends.
uint32_t linkNow(const CarryPush& push, uint32_t leaf) {
    return leaf < push.leafCount ? push.leavesWent.v[leaf] : kNoIndex;
}

// One after the other: what one leaves the next one takes.
void moveSpans(const CarryPush& push) {
    for (uint32_t from = 0; from < push.nodeCount; ++from) {
        const uint32_t to = push.nodesWent.v[from];
        if (to == kNoIndex) continue;
        if (to != from) {
            push.spansTo.v[to] = push.spansTo.v[from];
            push.keysTo.v[to] = push.keys.v[from];
        }
        push.leafHeadsTo.v[to] = linkNow(push, push.leafHeads.v[from]);
    }
}

void moveLeaves(const CarryPush& push) {
    for (uint32_t from = 0; from < push.leafCount; ++from) {
        const uint32_t to = push.leavesWent.v[from];
        if (to == kNoIndex) continue;
        if (to != from) {
            push.leavesTo.v[to] = push.leavesTo.v[from];
            push.keysTo.v[push.leafBaseTo + to] = push.keys.v[push.leafBase + from];
        }
        push.leafNextTo.v[to] = linkNow(push, push.leafNext.v[from]);
    }
}

void moveOrder(const CarryPush& push, const EmitCell& cell, uint32_t first) {
    const uint32_t *from = push.order.v + cell.first, *end = from + cell.count;
    uint32_t* to = push.orderTo.v + first;
    if (!IS_GIVEN(push.nodesWent)) {
        std::copy(from, end, to);
        return;
    }
    for (; from < end; ++from, ++to)
        *to = *from < push.leafBase ? push.nodesWent.v[*from]
                                    : push.leafBaseTo + push.leavesWent.v[*from - push.leafBase];
}

}  // namespace

void carryNative(const CarryPush& push, unsigned threads) {
    Crew crew(threads);
    if (IS_GIVEN(push.nodesWent))
        crew.overRange(2, 1, [&](size_t part, size_t) { part == 0 ? moveSpans(push) : moveLeaves(push); });
    uint32_t ordered = 0;
    std::vector<uint32_t> firsts(kAllCells);
    for (uint32_t c = 0; c < kAllCells; ++c) {
        firsts[c] = ordered;
        ordered += roomFor(push.cells.v[c].count);
    }
    push.cells.v[kAllCells].count = ordered;
    crew.overRange(kAllCells, kCellsAtOnce, [&](size_t begin, size_t end) {
        for (size_t c = begin; c < end; ++c) {
            EmitCell& cell = push.cells.v[c];
            moveOrder(push, cell, firsts[c]);
            cell.first = firsts[c];
            cell.room = roomFor(cell.count);
        }
    });
}

}  // namespace espalier
