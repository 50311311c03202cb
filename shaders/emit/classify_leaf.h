// Is a loose terminal seen, in which bucket and how large? The text of a kernel, and in C++ of a member: `view`, `table`
// and leafTexel() are around it.
uint bucketOfLeaf(uint item, OUT(DrawnItem) o) {
    vec3 origin = uintBitsToFloat(uvec3(leafTexel(4u * item)));
    uvec4 d = leafTexel(4u * item + 3u);
    uint kind = (d.w >> 8u) & 255u;
    uint variant = table.kinds[kind].firstVariant + (d.z >> 3u) % table.kinds[kind].variantCount;
    uint bucket = table.variants[variant].firstBucket;
    o.item = item;
    o.bits = 0u;
    o.value = 1.0f;
    o.place = 0u;
    // No branch on what is the same in all of a view; see keep_cell.h.
    if (kind < kMaxTerminalKinds * (1u - (view.flags & kFullDetail))) {
        float size = decodeLeafSize(d.w & 255u);
        float pixels = pixelsPerMetre(view, origin) * size;
        float share = leafShare(view, pixels);
        o.value = leafGrowth(share);
        float reach = size * o.value * table.variants[variant].extent;
        bool seen = leafIsKept(share, d.z) && !outside(view, origin, reach);
        if (seen && IS_GIVEN(view.tiles)) seen = !hidden(view, origin, reach);
        uint lod = table.variants[variant].lodCount - 1u;
        float drawn = max(pixels, view.wholePixels);   // smaller ones are drawn as large as this
        while (lod > 0u && table.variants[variant].error[lod] * drawn > view.lodPixels) --lod;
        bucket = seen ? bucket + lod : kNoBucket;
        o.bits = lod;
    }
    return bucket;
}
