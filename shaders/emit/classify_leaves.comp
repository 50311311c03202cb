#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/extensions.glsl"
// A loose terminal each: is it seen, in which shape and at which LOD?
#include "shaders/emit/bucket_count.glsl"
#include "shaders/emit/leaf_thinning.glsl"
#include "shaders/shared/dispatch.glsl"

layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Data { EmitPush push; };

uint pickBucket(EmitView view, VariantRecord variant, Leaf leaf, LeafPose pose, uint hash) {
    Node node = push.nodes.v[leaf.node];
    uint before = previousNode(push.chunks, node, leaf.node);
    if (before == kNoIndex) return kNoBucket;
    uint ib = node.place >> 16u;
    vec3 p3 = placePoint(push.surfaces.v[ib].toWorld[0], push.surfaces.v[ib].toWorld[1],
                         push.surfaces.v[ib].toWorld[2], node.position);
    Node start = push.nodes.v[before];
    uint ia = start.place >> 16u;
    vec3 p0 = placePoint(push.surfaces.v[ia].toWorld[0], push.surfaces.v[ia].toWorld[1],
                         push.surfaces.v[ia].toWorld[2], start.position);
    vec3 center = mix(p0, p3, pose.t);
    float reach = 0.5 * distance(p0, p3) + pose.lift + 2.0 * node.radius + pose.size * (2.0 * variant.extent + 0.3);
    if (outside(view, center, reach)) return kNoBucket;
    float pixels = pixelsPerMetre(view, center) * pose.size;
    if (!leafIsKept(pixels, hash) || hidden(view, center, reach)) return kNoBucket;
    uint lod = variant.lodCount - 1u;
    while (lod > 0u && variant.error[lod] * pixels > view.lodPixels) --lod;
    return variant.firstBucket + lod;
}

void main() {
    uint i = itemIndex();
    uint bucket = kNoBucket;
    uint triangles = 0u;
    if (i < push.leafCount) {
        Leaf leaf = push.leaves.v[i];
        LeafPose pose = unpackLeaf(leaf.place, leaf.pose, leaf.tint);
        if (leaf.node < push.nodeCount && pose.mesh < push.table.v[0].kindCount) {
            KindRecord kind = push.table.v[0].kinds[pose.mesh];
            if (kind.variantCount > 0u && kind.bark == 0u) {
                uint hash = leafHash(leaf);
                VariantRecord variant = push.table.v[0].variants[kind.firstVariant + (hash >> 3u) % kind.variantCount];
                triangles = push.table.v[0].buckets[variant.firstBucket].indexCount / 3u;
                bucket = (push.view.v[0].flags & kFullDetail) != 0u
                             ? variant.firstBucket
                             : pickBucket(push.view.v[0], variant, leaf, pose, hash);
            }
        }
    }
    uint word = countInBucket(push.state, push.table, bucket, triangles);
    if (i < push.leafCount) push.classes.v[push.nodeCount + i] = word;
}
