#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/extensions.glsl"
// A node each: is its span's bark seen, and at which LOD? Leaves the buckets' counts and notes of what is seen. Loops of
// one round: a device that runs all lanes through both sides of an `if` does leave a loop early.
#include "shaders/emit/keep.glsl"
#include "shaders/emit/sight.glsl"
#include "shaders/emit/span_thinning.glsl"
#include "shaders/shared/dispatch.glsl"

layout(local_size_x = 64) in;

// By its ends alone: a curve's handles are no longer than its chord.
bool maybeSeen(Node node, uint before) {
    Node start = push.nodes.v[before];
    uint ib = node.place >> 16u;
    vec4 r0 = push.surfaces.v[ib].toWorld[0];
    vec4 r1 = push.surfaces.v[ib].toWorld[1];
    vec4 r2 = push.surfaces.v[ib].toWorld[2];
    vec3 p3 = placePoint(r0, r1, r2, node.position);
    uint ia = start.place >> 16u;
    for (bool other = ia != ib; other; other = false) {
        r0 = push.surfaces.v[ia].toWorld[0];
        r1 = push.surfaces.v[ia].toWorld[1];
        r2 = push.surfaces.v[ia].toWorld[2];
    }
    vec3 p0 = placePoint(r0, r1, r2, start.position);
    vec3 center = (p0 + p3) * 0.5;
    float thick = max(start.radius, node.radius * kChildFlare);
    if (outside(view, center, 1.5 * distance(p0, p3) + 4.0 * thick)) return false;
    float thin = thick * pixelsPerMetre(view, center) / view.leastPixels;
    return thin >= 0.06 && spanIsKept(thin, push.chunks.v[node.chunk].key);
}

uint pickBucket(VariantRecord variant, LoadedSpan s) {
    vec3 center = (s.span.p0 + s.span.p3) * 0.5;
    float thick = max(s.radius0, s.radius1);
    float reach = max(max(distance(center, s.span.b1), distance(center, s.span.b2)), distance(center, s.span.p0));
    if (outside(view, center, reach + 2.0 * thick)) return kNoBucket;
    float pixels = pixelsPerMetre(view, center);
    if (hidden(view, center, reach + 2.0 * thick)) return kNoBucket;
    // How far the curve swings away from its chord; n straight pieces leave about 1/n² of it.
    vec3 chord = s.span.p3 - s.span.p0;
    float bend = 0.75 * max(length(s.span.b1 - s.span.p0 - chord / 3.0), length(s.span.b2 - s.span.p3 + chord / 3.0));
    uint lod = variant.lodCount - 1u;
    while (lod > 0u) {
        float error = variant.error[lod] * thick + bend / (variant.segments[lod] * variant.segments[lod]);
        if (error * pixels <= view.lodPixels) break;
        --lod;
    }
    return variant.firstBucket + lod;
}

void main() {
    uint i = itemIndex();
    uint bucket = kNoBucket;
    uint triangles = 0u;
    for (bool given = i < push.nodeCount; given; given = false) {
        Node node = push.nodes.v[i];
        uint kind = (node.flags >> 18u) & 255u;
        bool bark = (node.flags & kNodeBark) != 0u && node.radius > 0.0 && kind < table.kindCount &&
                    table.kinds[kind].variantCount > 0u && table.kinds[kind].bark != 0u;
        uint before = bark ? previousNode(push.chunks, node, i) : kNoIndex;
        for (bool spans = before != kNoIndex; spans; spans = false) {
            uint v = table.kinds[kind].firstVariant;
            triangles = table.buckets[table.variants[v].firstBucket].indexCount / 3u;
            bool full = (view.flags & kFullDetail) != 0u;
            if (full) bucket = table.variants[v].firstBucket;
            for (bool taken = !full && maybeSeen(node, before); taken; taken = false)
                bucket = pickBucket(table.variants[v], loadSpan(push.nodes, push.chunks, push.surfaces, i));
        }
    }
    keepItem(i, bucket, triangles, 0u, 0u);
}
