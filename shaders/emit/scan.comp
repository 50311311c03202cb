#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/extensions.glsl"
// Counts -> starts, indirect draws and totals. One invocation: there are 64 buckets.
#include "shaders/emit/emit_records.h"

layout(local_size_x = 1) in;
layout(push_constant, scalar) uniform Data { EmitPush push; };
layout(set = 0, binding = 0, scalar) uniform TableBlock { EmitTable table; };

// Full batches in one command, the rest in another, so that small meshes aren't drawn one by one.
void writeDraws(uint b, uint count) {
    BucketRecord bucket = table.buckets[b];
    uint batch = max(bucket.batch, 1u);
    DrawCommand whole = DrawCommand(bucket.indexCount * batch, count / batch, bucket.firstIndex, 0, 0u);
    uint rest = count % batch;
    DrawCommand last = DrawCommand(bucket.indexCount * rest, rest > 0u ? 1u : 0u, bucket.firstIndex,
                                   int((count - rest) * bucket.vertexCount), 0u);
    push.state.v[0].draws[2u * b] = whole;
    push.state.v[0].draws[2u * b + 1u] = last;
}

// Groups of 64, over y beyond 65,535 (shaders/shared/dispatch.glsl).
void writeGroups(uint kind) {
    uint groups = (push.state.v[0].kept[kind] + 63u) / 64u;
    push.state.v[0].writeGroups[3u * kind] = min(groups, 65535u);
    push.state.v[0].writeGroups[3u * kind + 1u] = groups == 0u ? 0u : (groups + 65534u) / 65535u;
    push.state.v[0].writeGroups[3u * kind + 2u] = 1u;
}

void main() {
    uint totals[2] = uint[2](0u, 0u);
    uint capacity[2] = uint[2](push.spanCapacity, push.leafCapacity);
    uint overflow = 0u;
    uint triangles = 0u;
    for (uint b = 0u; b < kMaxBuckets; ++b) {
        uint kind = b < table.barkBuckets ? 0u : 1u;
        uint count = push.state.v[0].counts[b];
        uint room = capacity[kind] - totals[kind];
        overflow += count > room ? count - room : 0u;
        count = min(count, room);
        push.state.v[0].starts[b] = totals[kind];
        push.state.v[0].counts[b] = count;
        totals[kind] += count;
        writeDraws(b, count);
        triangles += count * (table.buckets[b].indexCount / 3u);
    }
    push.state.v[0].spanCount = totals[0];
    push.state.v[0].leafCount = totals[1];
    push.state.v[0].overflow = overflow;
    push.state.v[0].drawnTriangles = triangles;
    writeGroups(0u);
    writeGroups(1u);
}
