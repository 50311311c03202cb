// What there is to bind, and how an item is given its bin. The text of kernels, and in C++ of a member: `push` is around
// it.
#define HEAD push.cells.v[kAllCells]

// Node i of those to look at, below nodesToBind().
uint nodesToBind() { return push.partly != 0u ? HEAD.reach : push.nodeCount; }
uint nodeToBind(uint i) {
    if (push.partly != 0u) return push.work.v[i];
    return i;
}

// A span's class by its thickness, in parts of a cell's side. The next one is for spans that far views don't draw, since
// the last of their stretch stands for them.
uint spanClass(float thick) {
    float t = thick * push.grid.rcpCell;
    return t > 0.012f ? 0u : t > 0.006f ? 2u : 4u;
}

// Takes an item out of where it was; whether it was there.
bool takeKey(uint item, bool before) {
    uint was = push.partly != 0u && before ? push.keys.v[item] : kNoIndex;
    push.keys.v[item] = kNoIndex;
    if (was != kNoIndex) push.cells.v[was / kCellBins].changed = 1u;
    return was != kNoIndex;
}
// bin: by its order of going.
void giveKey(uint item, uint kind, vec3 center, uint bin) {
    uint cell = kind * kMaxCells + cellOf(push.grid, center);
    push.keys.v[item] = (cell * kCellBins + bin) | kFresh;
    IF_ANY(push.partly != 0u) {
        push.cells.v[cell].changed = 1u;
        push.list.v[atomicAdd(HEAD.changed, 1u)] = item;
    }
}

// Item i of those that are put into cells, below itemsToPut().
uint itemsToPut() { return push.partly != 0u ? HEAD.changed : push.nodeCount + push.leafCount; }
uint itemToPut(uint i) {
    if (push.partly != 0u) return push.list.v[i];
    return i < push.nodeCount ? i : push.leafBase + i - push.nodeCount;
}
