#version 460
#extension GL_GOOGLE_include_directive : require
// What the rounds have left, by one group that goes on until all is decided: most often nothing.
#include "shaders/expand/avoid.glsl"

// In each sweep the chunk that comes first is decided, so no wave needs as many.
const uint kMostSweeps = 4096u;

shared uint left, pending;

// Decides those of 32 chunks that aren't.
void settleBlock(uint first, uint end) {
    UintBuf bounds = env.status.v[0].avoidBounds;
    uint lane = gl_LocalInvocationID.x;
    if (lane == 0u) pending = 0u;
    syncGroup();
    if (first + lane < end && !isDecided(LOAD_MEANWHILE(bounds.v[first + lane]))) atomicOr(pending, 1u << lane);
    syncGroup();
    for (uint bits = pending; bits != 0u; bits = bits & (bits - 1u)) {
        uint chunk = first + uint(findLSB(bits));
        uint known = LOAD_MEANWHILE(bounds.v[chunk]);
        syncGroup();   // before one of the lanes changes it
        decideChunk(chunk, known);
    }
    syncGroup();
}

void main() {
    bool room = roomToAvoid(env);
    uint end = env.status.v[0].chunks;
    uint begin = env.status.v[0].waveFirst;
    for (uint sweep = 0u; sweep < kMostSweeps && room; ++sweep) {
        if (gl_LocalInvocationID.x == 0u) left = LOAD_MEANWHILE(env.status.v[0].waveUndecided);
        syncGroup();
        bool done = left == 0u;
        syncGroup();
        if (done) break;
        for (uint first = begin; first < end; first += kExpandGroup) settleBlock(first, end);
    }
    syncGroup();
    // Software devices end long loops early: then the attempt ends here, and the next has more rounds.
    room = room && LOAD_MEANWHILE(env.status.v[0].waveUndecided) == 0u;
    if (gl_LocalInvocationID.x == 0u) endDecisions(env, room);
}
