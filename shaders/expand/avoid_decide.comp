#version 460
#extension GL_GOOGLE_include_directive : require
// One round: chunks of the latest wave that aren't decided, a group a chunk.
#include "shaders/expand/avoid.glsl"

void main() {
    if (!roomToAvoid(env)) return;
    uint end = env.status.v[0].chunks;
    UintBuf bounds = env.status.v[0].avoidBounds;
    for (uint chunk = env.status.v[0].waveFirst + gl_WorkGroupID.x; chunk < end; chunk += gl_NumWorkGroups.x) {
        uint known = bounds.v[chunk];
        if (!isDecided(known)) decideChunk(chunk, known);
    }
}
