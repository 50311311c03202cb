// Is a span's bark seen, in which bucket, how thick and how faint? The text of a kernel, and in C++ of a member: `view`,
// `table` and spanTexel() are around it.
uint bucketOfSpan(uint item, OUT(DrawnItem) o) {
    uvec4 d = spanTexel(6u * item + 3u);
    uvec4 e = spanTexel(6u * item + 4u);
    float thick = max(uintBitsToFloat(d.z), uintBitsToFloat(d.w));
    float order = float(e.w >> 16u) * (1.0f / 65535.0f);
    uint variant = table.kinds[e.w & 63u].firstVariant;
    uint bucket = table.variants[variant].firstBucket;
    o.item = item;
    o.bits = 0xFFFF0000u;
    o.value = 0.0f;
    o.place = 0u;
    // No branch on what is the same in all of a view; see keep_cell.h. No bark is without variants.
    uint kinds = kMaxTerminalKinds * (1u - (view.flags & kFullDetail));
    if ((e.w & 63u) < kinds) {
        uvec4 f = spanTexel(6u * item + 5u);
        vec4 sphere = vec4(uintBitsToFloat(f.x), uintBitsToFloat(f.y), uintBitsToFloat(f.z), uintBitsToFloat(f.w));
        vec2 errors = unpackHalf2x16(e.z);
        float stretches = float((view.flags & kStretches) / kStretches);
        bool joined = errors.y * pixelsPerMetre(view, vec3(sphere)) <= mix(-1.0f, view.lodPixels, stretches);
        if (!joined) {
            uvec4 a = spanTexel(6u * item);
            uvec4 b = spanTexel(6u * item + 1u);
            uvec4 c = spanTexel(6u * item + 2u);
            sphere = spanSphere(uintBitsToFloat(uvec3(a)), uintBitsToFloat(uvec3(a.w, b.x, b.y)),
                                uintBitsToFloat(uvec3(b.z, b.w, c.x)), uintBitsToFloat(uvec3(c.y, c.z, c.w)));
        }
        float pixels = pixelsPerMetre(view, vec3(sphere));
        float thin = thick * pixels / view.leastPixels;
        float reach = sphere.w + 2.0f * max(thick, view.leastPixels / pixels);
        bool seen = (!joined || (e.w & 0x8000u) != 0u) && thin >= kThinnest && spanIsKept(thin, order) &&
                    !outside(view, vec3(sphere), reach);
        if (seen && IS_GIVEN(view.tiles)) seen = !hidden(view, vec3(sphere), reach);
        // n straight pieces leave about 1/n² of the bend.
        uint lod = table.variants[variant].lodCount - 1u;
        while (lod > 0u && !joined) {
            float pieces = table.variants[variant].segments[lod];
            if ((table.variants[variant].error[lod] * thick + errors.x / (pieces * pieces)) * pixels <= view.lodPixels) break;
            --lod;
        }
        bucket = seen ? bucket + lod : kNoBucket;
        o.bits = lod | (joined ? (e.w >> 9u) & 56u : 0u) | (uint(spanFade(thin, order) * 65535.0f + 0.5f) << 16u);
        o.value = view.leastPixels / pixels;
    }
    return bucket;
}
