// A group takes a block of items, a lane an item of it. Each item that is seen gets its rank in its bucket and block:
// with the blocks' order that makes the order of drawing, the same in every run.
#ifndef ESPALIER_EMIT_BLOCK_GLSL
#define ESPALIER_EMIT_BLOCK_GLSL
#include "shaders/emit/emit_inputs.glsl"

layout(constant_id = kConstantLanes) const uint kRankLanes = 1u;   // 1: the first lane ranks all; else each its own item

shared uint laneBuckets[64];
shared uint laneRanks[64];
shared uint bucketCounts[64];

// Of a class; groups that are spread over y overhang its blocks.
#define groupIndex() (gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x)

// All invocations of the group call it. Leaves the note of what this lane has found, and the block's counts. count: items
// of the block.
void noteItem(uint block, uint count, DrawnItem found, uint bucket) {
    uint lane = gl_LocalInvocationID.x;
    laneBuckets[lane] = bucket;
    bucketCounts[lane] = 0u;
    barrier();
    if (kRankLanes > 1u) {
        uint rank = 0u;
        for (uint i = 0u; i < lane; ++i) rank += laneBuckets[i] == bucket ? 1u : 0u;
        laneRanks[lane] = rank;
        if (bucket != kNoBucket) atomicAdd(bucketCounts[bucket], 1u);
    }
    // One item after another.
    for (uint i = 0u; i < (kRankLanes == 1u && lane == 0u ? count : 0u); ++i) {
        uint b = laneBuckets[i];
        if (b != kNoBucket) laneRanks[i] = bucketCounts[b]++;
    }
    barrier();
    found.place = (bucket << 24u) | laneRanks[lane];
    push.notes.v[block * kBlockItems + lane] = found;
    push.rows.v[block * kMaxBuckets + lane] = bucketCounts[lane];
}
#endif
