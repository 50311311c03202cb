// An item is counted in its bin, and how far and how large it is in its cell. The text of a kernel, and in C++ of a
// member: `push`, `table`, spanTexel(), leafTexel() and bind_item.h are around it.
void countItem(uint item) {
    uint key = push.keys.v[item];
    if (key != kNoIndex) {
        key &= ~kFresh;
        uint cell = key / kCellBins;
        vec3 center;
        float large;
        float reach;
        if (item < push.leafBase) {
            uvec4 d = spanTexel(6u * item + 3u);
            uvec4 f = spanTexel(6u * item + 5u);
            center = uintBitsToFloat(uvec3(f));
            large = max(uintBitsToFloat(d.z), uintBitsToFloat(d.w));
            reach = uintBitsToFloat(f.w) + 2.0f * large;
        } else {
            uint leaf = 4u * (item - push.leafBase);
            uvec4 d = leafTexel(leaf + 3u);
            uint kind = (d.w >> 8u) & 255u;
            uint variant = table.kinds[kind].firstVariant + (d.z >> 3u) % table.kinds[kind].variantCount;
            center = uintBitsToFloat(uvec3(leafTexel(leaf)));
            large = decodeLeafSize(d.w & 255u);
            reach = large * table.variants[variant].extent;
        }
        float away = distance(center, cellMiddle(push.grid, cell % kMaxCells)) + reach;
        atomicAdd(push.bins.v[key], 1u);
        atomicMax(push.cells.v[cell].reach, floatBitsToUint(away));
        atomicMax(push.cells.v[cell].largest, floatBitsToUint(large));
    }
}
