// Keeps the items of a workgroup that are seen: each gets its place in its bucket, with one atomic a bucket and group,
// and is noted, so that writing looks at nothing else.
#ifndef ESPALIER_EMIT_KEEP_GLSL
#define ESPALIER_EMIT_KEEP_GLSL
#include "shaders/emit/emit_inputs.glsl"

shared uint groupCounts[64];
shared uint groupStarts[64];
shared uint groupTriangles, groupKept, groupFirst;

// All invocations of the group call it. kind: 0 spans, 1 leaves; first: where their notes begin.
void keepItem(uint item, uint bucket, uint fullTriangles, uint kind, uint first) {
    uint lane = gl_LocalInvocationID.x;
    groupCounts[lane] = 0u;
    if (lane == 0u) {
        groupTriangles = 0u;
        groupKept = 0u;
    }
    barrier();
    uint place = 0u;
    uint note = 0u;
    if (bucket != kNoBucket) {
        place = atomicAdd(groupCounts[bucket], 1u);
        note = atomicAdd(groupKept, 1u);
    }
    if (fullTriangles != 0u) atomicAdd(groupTriangles, fullTriangles);
    barrier();
    if (groupCounts[lane] != 0u) groupStarts[lane] = atomicAdd(push.state.v[0].counts[lane], groupCounts[lane]);
    if (lane == 0u && groupTriangles != 0u) atomicAdd(push.state.v[0].fullTriangles, groupTriangles);
    if (lane == 0u && groupKept != 0u) groupFirst = atomicAdd(push.state.v[0].kept[kind], groupKept);
    barrier();
    if (bucket != kNoBucket)
        push.kept.v[first + groupFirst + note] = KeptItem(item, classWord(bucket, groupStarts[bucket] + place));
}
#endif
