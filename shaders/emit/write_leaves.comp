#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/extensions.glsl"
// Writes the seen loose terminals as instances, each bucket's together.
#include "shaders/emit/emit_inputs.glsl"
#include "shaders/emit/leaf_thinning.glsl"
#include "shaders/shared/dispatch.glsl"

layout(local_size_x = 64) in;

#include "shaders/emit/shown_depth.glsl"

void main() {
    uint k = itemIndex();
    if (k >= push.state.v[0].kept[1]) return;
    KeptItem kept = push.kept.v[push.nodeCount + k];
    uint bucket = classBucket(kept.word);
    uint place = classPlace(kept.word);
    if (place >= push.state.v[0].counts[bucket]) return;
    Leaf record = push.leaves.v[kept.item];
    LeafPose pose = unpackLeaf(record.place, record.pose, record.tint);
    uint hash = leafHash(record);
    KindRecord kind = table.kinds[pose.mesh];
    uint v = kind.firstVariant + (hash >> 3u) % kind.variantCount;
    LoadedSpan s = loadSpan(push.nodes, push.chunks, push.surfaces, record.node);
    PlacedLeaf leaf = placeLeaf(s, pose, hash, table.variants[v].extent);
    if ((view.flags & kFullDetail) == 0u) {
        float pixels = view.pixelScale / (view.parallel != 0u ? 1.0 : max(distance(view.eye, leaf.origin), 1e-6));
        leaf.size *= leafGrowth(pixels * leaf.size);
    }
    LeafInstance o;
    o.origin = leaf.origin;
    o.axisX = leaf.axisX * leaf.size;
    o.axisY = leaf.axisY * leaf.size;
    o.axisZ = leaf.axisZ * leaf.size;
    o.normal = packOct(leaf.normal);
    o.tint = record.tint;
    o.hash = hash;
    float height = clamp(leaf.height / max(1.1 * leaf.size, 1e-6), 0.0, 1.0);
    o.bits = (bucket - table.variants[v].firstBucket) | shownDepth(record.node) | (pose.mesh << 8u) | (uint(height * 65535.0 + 0.5) << 16u);
    push.leafInstances.v[push.state.v[0].starts[bucket] + place] = o;
}
