#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/extensions.glsl"
// A node each: is its span's bark seen, and at which LOD? Leaves a class word and the buckets' counts.
#include "shaders/emit/span_load.h"
#include "shaders/emit/bucket_count.glsl"
#include "shaders/shared/dispatch.glsl"

layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Data { EmitPush push; };

uint pickBucket(EmitView view, VariantRecord variant, LoadedSpan s) {
    vec3 center = (s.span.p0 + s.span.p3) * 0.5;
    float thick = max(s.radius0, s.radius1);
    float reach = max(max(distance(center, s.span.b1), distance(center, s.span.b2)), distance(center, s.span.p0));
    if (outside(view, center, reach + 2.0 * thick)) return kNoBucket;
    float pixels = pixelsPerMetre(view, center);
    if (thick * pixels < view.leastPixels * 0.06) return kNoBucket;
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
    if (i < push.nodeCount) {
        Node node = push.nodes.v[i];
        uint kind = (node.flags >> 18u) & 255u;
        if ((node.flags & kNodeBark) != 0u && node.radius > 0.0 && kind < push.table.v[0].kindCount &&
            push.table.v[0].kinds[kind].variantCount > 0u && push.table.v[0].kinds[kind].bark != 0u) {
            LoadedSpan s = loadSpan(push.nodes, push.chunks, push.surfaces, i);
            if (s.valid) {
                uint v = push.table.v[0].kinds[kind].firstVariant;
                VariantRecord variant = push.table.v[0].variants[v];
                triangles = push.table.v[0].buckets[variant.firstBucket].indexCount / 3u;
                bucket = (push.view.v[0].flags & kFullDetail) != 0u ? variant.firstBucket
                                                                   : pickBucket(push.view.v[0], variant, s);
            }
        }
    }
    uint word = countInBucket(push.state, push.table, bucket, triangles);
    if (i < push.nodeCount) push.classes.v[i] = word;
}
