#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/extensions.glsl"
// A loose terminal each, on the span that bind_spans has made: an instance in the world, put into its cell.
#include "shaders/emit/watch.glsl"
#include "shaders/emit/instance_texels.glsl"
#include "shaders/emit/leaf_place.h"
#include "shaders/shared/expand_env.h"

layout(local_size_x = 64) in;
layout(constant_id = 3) const uint kRecordsByAddress = 1u;
layout(set = 0, binding = 0, scalar) uniform TableBlock { EmitTable table; };
layout(set = 0, binding = 1) uniform usamplerBuffer leafTexels;
layout(set = 0, binding = 2) uniform usamplerBuffer spanTexels;

Leaf readLeaf(uint i) {
    if (kRecordsByAddress != 0u) return push.leaves.v[i];
    uvec4 t = TEXEL(leafTexels, i);
    return Leaf(t.x, t.y, t.z, t.w);
}

void writeLeaf(uint i, LeafInstance o) {
    PairBuf to = PairBuf(uint64_t(push.leafInstances) + uint64_t(i) * 64u);
    to.v[0] = pairOf(o.origin.x, o.origin.y);
    to.v[1] = pairOf(o.origin.z, o.axisX.x);
    to.v[2] = pairOf(o.axisX.y, o.axisX.z);
    to.v[3] = pairOf(o.axisY.x, o.axisY.y);
    to.v[4] = pairOf(o.axisY.z, o.axisZ.x);
    to.v[5] = pairOf(o.axisZ.y, o.axisZ.z);
    to.v[6] = pairOf(o.normal, o.tint);
    to.v[7] = pairOf(o.hash, o.bits);
}

LoadedSpan spanUnder(SpanInstance o) {
    LoadedSpan s;
    s.span = Span(o.p0, o.b1, o.b2, o.p3);
    s.normal0 = unpackOct(o.normal0);
    s.normal1 = unpackOct(o.normal1);
    s.radius0 = o.radius0;
    s.radius1 = o.radius1;
    return s;
}

uint variantOf(uint bits, uint hash) {
    KindRecord kind = table.kinds[(bits >> 8u) & 255u];
    return kind.firstVariant + (hash >> 3u) % kind.variantCount;
}
uint trianglesOf(uint variant) { return table.buckets[table.variants[variant].firstBucket].indexCount / 3u; }

void takeLeaf(uint i) {
    uint bits = push.leafInstances.v[i].bits;
    uint variant = variantOf(bits, push.leafInstances.v[i].hash);
    atomicAdd(HEAD.first, 0u - trianglesOf(variant));
    noteLeaf(push.leafInstances.v[i].origin, decodeLeafSize(bits & 255u), table.variants[variant].extent);
}

void bindLeaf(uint i) {
    Leaf record = readLeaf(i);
    uint item = push.leafBase + i;
    if (takeKey(item, i < push.leavesBefore)) takeLeaf(i);
    LeafPose pose = unpackLeaf(record.place, record.pose, record.tint);
    bool known = record.node < push.nodeCount && pose.mesh < table.kindCount &&
                 table.kinds[pose.mesh].variantCount > 0u && table.kinds[pose.mesh].bark == 0u;
    if (known) {
        push.leafNext.v[i] = atomicExchange(push.leafHeads.v[record.node], i);
        SpanInstance under = SPAN_INSTANCE(spanTexels, record.node);
        uint hash = leafHash(record);
        KindRecord kind = table.kinds[pose.mesh];
        uint v = kind.firstVariant + (hash >> 3u) % kind.variantCount;
        if (under.reach >= 0.0) {
            PlacedLeaf leaf = placeLeaf(spanUnder(under), pose, hash, table.variants[v].extent);
            LeafInstance o;
            o.origin = leaf.origin;
            o.axisX = leaf.axisX * leaf.size;
            o.axisY = leaf.axisY * leaf.size;
            o.axisZ = leaf.axisZ * leaf.size;
            o.normal = packOct(leaf.normal);
            o.tint = record.tint;
            o.hash = hash;
            float height = clamp(leaf.height / max(1.1 * leaf.size, 1e-6), 0.0, 1.0);
            o.bits = (record.place & 0xFFFFu) | (((under.bits >> 7u) & 31u) << 16u) | (uint(height * 2047.0 + 0.5) << 21u);
            writeLeaf(i, o);
            giveKey(item, kLeafClass, o.origin, (hash >> 8u) / (0x1000000u / kCellBins));
            atomicAdd(HEAD.first, trianglesOf(v));
            noteLeaf(o.origin, decodeLeafSize(o.bits & 255u), table.variants[v].extent);
        }
    }
}

// All of them; or those on nodes whose spans were bound anew, and those that there weren't before.
void main() {
    uint listed = push.partly != 0u ? min(HEAD.largest, push.leavesBefore) : 0u;
    uint count = push.partly != 0u ? listed + push.leafCount - push.leavesBefore : push.leafCount;
    for (uint i = FIRST_LANE; i < count; i += LANES) {
        uint leaf = push.partly != 0u ? push.leavesBefore + i - listed : i;
        if (i < listed) leaf = push.work.v[push.leafWork + i];
        bindLeaf(leaf);
    }
}
