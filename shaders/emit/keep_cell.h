// How many items of cell `i`, by their order of going, a view keeps at its distance; 0: none of it is seen. The text of
// a kernel, and in C++ of a member: `view` and `push` are around it.
uint keptOfCell(uint i) {
    EmitCell cell = push.cells.v[i];
    uint kept = cell.count;
    if (kept > 0u && (view.flags & kFullDetail) == 0u) {
        bool leaves = i >= kLeafClass * kMaxCells;
        vec3 middle = cellMiddle(push.grid, i % kMaxCells);
        float reach = uintBitsToFloat(cell.reach);
        float largest = uintBitsToFloat(cell.largest);
        // No branch here on what is the same in all of a view: lavapipe would compile the kernel anew for every value
        // of the view, frame by frame, and keep each.
        float away = max(distance(view.eye, middle) - reach, 1e-6f);
        float pixels = view.pixelScale / (view.parallel == 0u ? away : 1.0f);
        // Share of the items that stay; leaves grow as others go, twigs are drawn at the least thickness.
        float share = leaves ? leafShare(view, largest * pixels) : largest * pixels / (view.leastPixels * kFaintest);
        // No leaf is drawn larger than the largest one where that is farthest away.
        float farPixels = view.pixelScale / (view.parallel == 0u ? distance(view.eye, middle) + reach : 1.0f);
        float drawn = largest * leafGrowth(leafShare(view, largest * farPixels));
        float most = reach + (leaves ? 1.3f * drawn : view.leastPixels / pixels);
        bool none = (!leaves && share * kFaintest < kThinnest) || outside(view, middle, most);
        if (!none && IS_GIVEN(view.tiles)) none = hidden(view, middle, most);
        uint last = min(uint(min(share, 1.0f) * float(kCellBins)), kCellBins - 1u);
        // Of odd classes those for whose stretches a ribbon would be too far off; one bin more, since errors are rounded.
        bool odd = !leaves && (i / kMaxCells & 1u) != 0u;
        uint off = min(errorBin(push.grid, view.lodPixels / pixels) + 1u, kCellBins - 1u);
        last = odd ? ((view.flags & kStretches) != 0u ? off : kCellBins - 1u) : last;
        kept = none ? 0u : push.bins.v[i * kCellBins + last];
    }
    return kept;
}
