// Cells of the order of items, when those that were bound are put there. The text of kernels, and in C++ of a member:
// `push` is around it, and bind_item.h.

// When only a part is bound: what stays in a changed cell is listed, to be put there again. lane: of `lanes` that share
// the cell.
void keepItems(uint cell, uint lane, uint lanes) {
    uint first = push.cells.v[cell].first;
    uint count = push.cells.v[cell].count;
    for (uint i = lane; i < count; i += lanes) {
        uint item = push.order.v[first + i];
        if ((push.keys.v[item] & kFresh) == 0u) push.list.v[atomicAdd(HEAD.changed, 1u)] = item;
    }
    for (uint b = lane; b < kCellBins; b += lanes) push.bins.v[cell * kCellBins + b] = 0u;
    if (lane == 0u) {
        push.cells.v[cell].reach = 0u;
        push.cells.v[cell].largest = 0u;
    }
}

// Room for a cell's items in the order, with some to spare, and where its bins begin in that. Which cell comes first is
// of no account: views go through cells by their number.
void makeCellRoom(uint cell) {
    uint total = 0u;
    for (uint bin = cell * kCellBins; bin < (cell + 1u) * kCellBins; ++bin) {
        uint count = push.bins.v[bin];
        push.bins.v[bin] = total;
        total += count;
    }
    uint room = roomFor(total);
    if (total > push.cells.v[cell].room) {
        uint first = atomicAdd(HEAD.count, room);
        if (first + room > push.orderRoom) {
            HEAD.room = push.binding;
            room = 0u;
            total = 0u;
            for (uint bin = cell * kCellBins; bin < (cell + 1u) * kCellBins; ++bin) push.bins.v[bin] = 0u;
        }
        push.cells.v[cell].first = first;
        push.cells.v[cell].room = room;
    }
    push.cells.v[cell].count = total;
}

// An item goes to its bin; where that began becomes where it ends.
void putItem(uint item) {
    uint key = push.keys.v[item];
    if (key != kNoIndex) {
        uint bin = key & ~kFresh;
        push.keys.v[item] = bin;
        uint cell = bin / kCellBins;
        if (push.cells.v[cell].count > 0u) {
            uint at = atomicAdd(push.bins.v[bin], 1u);
            push.order.v[push.cells.v[cell].first + at] = item;
        }
    }
}
