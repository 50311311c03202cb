// Where the last span of a stretch ends: a sphere around all of the stretch, and how far one ribbon from its beginning to
// its end would be off, for each of its spans. The text of a kernel, and in C++ of a member: `push`, `table`,
// spanTexel() and bind_item.h are around it.

struct Curve {
    vec3 p0, b1, b2, p3;
};
Curve curveOf(uint i) {
    uvec4 a = spanTexel(6u * i);
    uvec4 b = spanTexel(6u * i + 1u);
    uvec4 c = spanTexel(6u * i + 2u);
    Curve o;
    o.p0 = uintBitsToFloat(uvec3(a));
    o.b1 = uintBitsToFloat(uvec3(a.w, b.x, b.y));
    o.b2 = uintBitsToFloat(uvec3(b.z, b.w, c.x));
    o.p3 = uintBitsToFloat(uvec3(c.y, c.z, c.w));
    return o;
}
float reachOfSpan(uint i) { return uintBitsToFloat(spanTexel(6u * i + 5u).w); }

float ribbonError(uint kind) {
    VariantRecord variant = table.variants[table.kinds[kind].firstVariant];
    return variant.error[variant.lodCount - 1u];
}

// A span's class and bin, by its stretch. order: of going.
void settleClass(uint item, bool last, float error, uint order) {
    uint key = push.keys.v[item];
    uint cell = (key & ~kFresh) / kCellBins;
    bool stood = !last && error < kNeverJoined;
    uint kind = ((cell / kMaxCells) & ~1u) + (stood ? 1u : 0u);
    uint bin = stood ? errorBin(push.grid, error) : order / (0x10000u / kCellBins);
    uint moved = (kind * kMaxCells + cell % kMaxCells) * kCellBins + bin;
    if (key != kNoIndex && (key & ~kFresh) != moved) {
        push.keys.v[item] = moved | kFresh;
        IF_ANY(push.partly != 0u) {
            push.cells.v[moved / kCellBins].changed = 1u;
            push.cells.v[cell].changed = 1u;
            if (key < kFresh) push.list.v[atomicAdd(HEAD.changed, 1u)] = item;
        }
    }
}

// What stays in its cell may reach further now.
void widen(uint item, vec3 center, float reach, float thick) {
    uint key = push.keys.v[item];
    if (key < kFresh) {
        uint cell = key / kCellBins;
        float away = distance(center, cellMiddle(push.grid, cell % kMaxCells)) + reach + 2.0f * thick;
        atomicMax(push.cells.v[cell].reach, floatBitsToUint(away));
    }
}

void bindStretch(uint end) {
    uint bits = spanTexel(6u * end + 4u).w;
    if ((bits & 0x8000u) != 0u) {
        uint kind = bits & 63u;
        uint first = end - ((bits >> 12u) & 7u);
        vec3 start = curveOf(first).p0;
        vec3 stop = curveOf(end).p3;
        vec3 along = stop - start;
        along *= inversesqrt(max(dot(along, along), 1e-30f));
        vec3 center = (start + stop) * 0.5f;
        float reach = 0.0f;
        float thick = 0.0f;
        float bend = 0.0f;
        float off = 0.0f;
        bool sound = kind != kNoBark;
        for (uint i = first; i <= end; ++i) {
            Curve s = curveOf(i);
            uvec4 d = spanTexel(6u * i + 3u);
            uvec4 e = spanTexel(6u * i + 4u);
            sound = sound && reachOfSpan(i) >= 0.0f && (e.w & 63u) == kind;
            reach = max(max(reach, max(distance(center, s.p0), distance(center, s.p3))),
                        max(distance(center, s.b1), distance(center, s.b2)));
            thick = max(thick, max(uintBitsToFloat(d.z), uintBitsToFloat(d.w)));
            bend = max(bend, unpackHalf2x16(e.z).x);
            vec3 arm = s.p3 - start;
            off = max(off, length(arm - along * dot(arm, along)));
        }
        float error = off + bend + (sound ? ribbonError(kind) * thick : 0.0f);
        sound = sound && error < kNeverJoined;
        error = sound ? error : kNeverJoined;
        for (uint i = first; i <= end; ++i) {
            uvec4 own = spanTexel(6u * i + 4u);
            push.spans.v[i].errors = packHalf2x16(vec2(unpackHalf2x16(own.z).x, error));
            Curve s = curveOf(i);
            vec4 sphere = sound ? vec4(center, reach) : spanSphere(s.p0, s.b1, s.b2, s.p3);
            if (reachOfSpan(i) >= 0.0f) {
                push.spans.v[i].center = vec3(sphere);
                push.spans.v[i].reach = sphere.w;
            }
            settleClass(i, i == end, error, own.w >> 16u);
            IF_ANY(push.partly != 0u) widen(i, vec3(sphere), sphere.w, thick);
        }
    }
}
