// Blocks' counts -> where each block's instances begin in their bucket; buckets' counts, starts and indirect draws. One
// group: of each bucket's blocks kShares lanes take a run each. The text of kernels, whose kShares is around it.
#include "shaders/emit/batches.h"
#include "shaders/emit/emit_inputs.glsl"

shared uint runs[kShares * kMaxBuckets];   // instances of a run that others follow
shared uint counts[kMaxBuckets];

void main() {
    // Lanes that follow each other take such buckets, whose counts lie side by side.
    uint lane = gl_LocalInvocationID.x;
    uint b = lane % kMaxBuckets;
    uint share = lane / kMaxBuckets;
    uint spans = push.state.v[0].blocks[0];
    bool bark = b < table.barkBuckets;
    uint first = bark ? 0u : spans;
    uint blocks = b >= table.bucketCount ? 0u : bark ? spans : push.state.v[0].blocks[1];
    uint run = (blocks + kShares - 1u) / kShares;
    uint begin = first + min(share * run, blocks);
    uint end = first + min((share + 1u) * run, blocks);
    uint sum = 0u;
    if (share + 1u < kShares)
        for (uint block = begin; block < end; ++block) sum += push.rows.v[block * kMaxBuckets + b];
    runs[lane] = sum;
    barrier();
    uint count = 0u;
    for (uint s = 0u; s < share; ++s) count += runs[s * kMaxBuckets + b];
    for (uint block = begin; block < end; ++block) {
        uint at = block * kMaxBuckets + b;
        uint here = push.rows.v[at];
        push.rows.v[at] = count;
        count += here;
    }
    if (share + 1u == kShares) counts[b] = count;
    barrier();
    if (share > 0u) return;
    uint start = 0u;
    for (uint i = 0u; i < b; ++i) start += counts[i];
    push.state.v[0].counts[b] = counts[b];
    push.state.v[0].starts[b] = start;
    DrawCommand whole;
    DrawCommand last;
    drawBatches(table.buckets[b], counts[b], whole, last);
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
