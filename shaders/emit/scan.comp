#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/shared/extensions.glsl"
// Blocks' counts -> where each block's instances begin in their bucket; buckets' counts, starts and indirect draws. One
// group: a lane takes a bucket.
#include "shaders/emit/batches.h"
#include "shaders/emit/emit_inputs.glsl"

layout(local_size_x = 64) in;

shared uint counts[64];

void main() {
    uint b = gl_LocalInvocationID.x;
    uint spans = push.state.v[0].blocks[0];
    bool bark = b < table.barkBuckets;
    uint block = bark ? 0u : spans;
    uint end = b >= table.bucketCount ? 0u : bark ? spans : spans + push.state.v[0].blocks[1];
    uint count = 0u;
    for (; block < end; ++block) {
        uint at = block * kMaxBuckets + b;
        uint here = push.rows.v[at];
        push.rows.v[at] = count;
        count += here;
    }
    counts[b] = count;
    barrier();
    uint start = 0u;
    for (uint i = 0u; i < b; ++i) start += counts[i];
    push.state.v[0].counts[b] = count;
    push.state.v[0].starts[b] = start;
    DrawCommand whole;
    DrawCommand last;
    drawBatches(table.buckets[b], count, whole, last);
    push.state.v[0].draws[2u * b] = whole;
    push.state.v[0].draws[2u * b + 1u] = last;
    if (b == 63u) {
        uint totals[2] = uint[2](0u, 0u);
        uint triangles = 0u;
        for (uint i = 0u; i < table.bucketCount; ++i) {
            totals[i < table.barkBuckets ? 0u : 1u] += counts[i];
            triangles += counts[i] * (table.buckets[i].indexCount / 3u);
        }
        push.state.v[0].spanCount = totals[0];
        push.state.v[0].leafCount = totals[1];
        push.state.v[0].drawnTriangles = triangles;
    }
}
