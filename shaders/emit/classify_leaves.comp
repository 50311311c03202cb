#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/extensions.glsl"
// A loose terminal each: is it seen, in which shape and at which LOD? Loops of one round: a device that runs all lanes
// through both sides of an `if` does leave a loop early.
#include "shaders/emit/keep.glsl"
#include "shaders/emit/leaf_thinning.glsl"
#include "shaders/emit/sight.glsl"
#include "shaders/shared/dispatch.glsl"

layout(local_size_x = 64) in;

uint pickBucket(VariantRecord variant, Leaf leaf, LeafPose pose, uint hash) {
    Node node = push.nodes.v[leaf.node];
    uint before = previousNode(push.chunks, node, leaf.node);
    if (before == kNoIndex) return kNoBucket;
    uint ib = node.place >> 16u;
    vec4 r0 = push.surfaces.v[ib].toWorld[0];
    vec4 r1 = push.surfaces.v[ib].toWorld[1];
    vec4 r2 = push.surfaces.v[ib].toWorld[2];
    vec3 p3 = placePoint(r0, r1, r2, node.position);
    Node start = push.nodes.v[before];
    uint ia = start.place >> 16u;
    for (bool other = ia != ib; other; other = false) {
        r0 = push.surfaces.v[ia].toWorld[0];
        r1 = push.surfaces.v[ia].toWorld[1];
        r2 = push.surfaces.v[ia].toWorld[2];
    }
    vec3 p0 = placePoint(r0, r1, r2, start.position);
    vec3 center = mix(p0, p3, pose.t);
    float reach = 0.5 * distance(p0, p3) + pose.lift + 2.0 * node.radius + pose.size * (2.0 * variant.extent + 0.3);
    if (outside(view, center, reach)) return kNoBucket;
    float pixels = pixelsPerMetre(view, center) * pose.size;
    if (!leafIsKept(pixels, hash)) return kNoBucket;
    bool seen = true;
    for (bool asked = u64(view.tiles) != 0ul; asked; asked = false) seen = !hidden(view, center, reach);
    uint lod = variant.lodCount - 1u;
    while (lod > 0u && variant.error[lod] * pixels > view.lodPixels) --lod;
    return seen ? variant.firstBucket + lod : kNoBucket;
}

void main() {
    uint i = itemIndex();
    uint bucket = kNoBucket;
    uint triangles = 0u;
    for (bool given = i < push.leafCount; given; given = false) {
        Leaf leaf = push.leaves.v[i];
        LeafPose pose = unpackLeaf(leaf.place, leaf.pose, leaf.tint);
        bool known = leaf.node < push.nodeCount && pose.mesh < table.kindCount &&
                     table.kinds[pose.mesh].variantCount > 0u && table.kinds[pose.mesh].bark == 0u;
        for (bool looked = known; looked; looked = false) {
            uint hash = leafHash(leaf);
            uint v = table.kinds[pose.mesh].firstVariant + (hash >> 3u) % table.kinds[pose.mesh].variantCount;
            triangles = table.buckets[table.variants[v].firstBucket].indexCount / 3u;
            bucket = (view.flags & kFullDetail) != 0u ? table.variants[v].firstBucket
                                                      : pickBucket(table.variants[v], leaf, pose, hash);
        }
    }
    keepItem(i, bucket, triangles, 1u, push.nodeCount);
}
