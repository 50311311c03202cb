// A share of a cell's bins: their items by where they are in the world, so that every run draws in the same order. The
// text of a kernel, and in C++ of a member: `push`, spanTexel() and leafTexel() are around it.

// Differs between instances and is the same in every run: of the end of a span, or of a leaf's place and turn.
uint rankOf(uint item, uint kind) {
    uvec4 t = kind < kLeafClass ? spanTexel(6u * item + 2u) : leafTexel(4u * (item - push.leafBase));
    uint h = t.x * 0x9E3779B1u ^ t.y * 0x85EBCA77u ^ t.z * 0xC2B2AE3Du ^ t.w * 0x27D4EB2Fu;
    return (h ^ (h >> 15u)) * 0x2C1B3C6Du;
}

// Of those few whose ranks are the same, the one with the lower number is first.
bool isBefore(uint item, uint rank, uint other, uint otherRank) {
    return rank < otherRank || (rank == otherRank && item < other);
}

// Of a heap of `count` items from `first` on, the last in order on top: `item` finds its place below `at`.
void sift(uint first, uint count, uint at, uint item, uint kind) {
    uint rank = rankOf(item, kind);
    uint child = 2u * at + 1u;
    while (child < count) {
        uint next = push.order.v[first + child];
        uint nextRank = rankOf(next, kind);
        if (child + 1u < count) {
            uint other = push.order.v[first + child + 1u];
            uint otherRank = rankOf(other, kind);
            if (isBefore(next, nextRank, other, otherRank)) {
                next = other;
                nextRank = otherRank;
                ++child;
            }
        }
        if (!isBefore(item, rank, next, nextRank)) break;
        push.order.v[first + at] = next;
        at = child;
        child = 2u * at + 1u;
    }
    push.order.v[first + at] = item;
}

void sortRun(uint first, uint end, uint kind) {
    // Where cells are coarse for what grows in them, bins are long: by a heap.
    uint heap = end - first > kLongRun ? end - first : 0u;
    for (uint at = heap / 2u; at > 0u; --at) sift(first, heap, at - 1u, push.order.v[first + at - 1u], kind);
    for (uint last = heap; last > 1u; --last) {
        uint item = push.order.v[first + last - 1u];
        push.order.v[first + last - 1u] = push.order.v[first];
        sift(first, last - 1u, 0u, item, kind);
    }
    end = heap > 0u ? first : end;
    for (uint i = first + 1u; i < end; ++i) {
        uint item = push.order.v[i];
        uint rank = rankOf(item, kind);
        uint to = i;
        while (to > first) {
            uint other = push.order.v[to - 1u];
            if (!isBefore(item, rank, other, rankOf(other, kind))) break;
            push.order.v[to] = other;
            --to;
        }
        push.order.v[to] = item;
    }
}

// shares: of a cell, each of as many bins.
void sortBins(uint cell, uint share, uint shares) {
    uint kind = cell / kMaxCells;
    uint first = push.cells.v[cell].first;
    uint bins = kCellBins / shares;
    uint bin = cell * kCellBins + share * bins;
    uint begin = share > 0u ? push.bins.v[bin - 1u] : 0u;
    for (uint b = bin; b < bin + bins; ++b) {
        uint end = push.bins.v[b];
        sortRun(first + begin, first + end, kind);
        begin = end;
    }
}
