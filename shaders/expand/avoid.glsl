// A group decides a chunk, a lane a span: expand_avoid.h.
#include "shaders/shared/extensions.glsl"
#include "shaders/shared/expand_avoid.h"

layout(local_size_x = 32) in;
layout(push_constant, scalar) uniform Push { ExpandEnv env; };

shared uint firstFall, firstYield, firstWait;

void syncGroup() {
    memoryBarrierBuffer();
    memoryBarrierShared();
    barrier();
}

// One round of an undecided chunk, by all lanes together.
void decideChunk(uint chunk, uint known) {
    uint lane = gl_LocalInvocationID.x;
    AvoidSite site = avoidSite(env, chunk);
    uint count = chunkNodes(env.chunks.v[chunk].marks);
    uint previousNode = env.chunks.v[chunk].previousNode;
    bool again = mayTryAgain(env, chunk, known);
    if (lane == 0u) {
        firstFall = mostOf(known);
        firstYield = mostOf(known);
        firstWait = mostOf(known);
    }
    syncGroup();
    if (lane >= leastOf(known) && lane < mostOf(known)) {
        uint verdict = verdictOf(env, site, spanAt(env, site.firstNode + lane, site.base));
        if (verdict == kSpanFalls) atomicMin(firstFall, lane);
        if (verdict == kSpanYields) atomicMin(firstYield, lane);
        if (verdict == kSpanWaits) atomicMin(firstWait, lane);
    }
    syncGroup();
    Found spans = Found(firstFall, firstYield, firstWait);
    uint found = boundsAfter(env, site, known, spans, again);
    syncGroup();   // that looks at flags, which cutNode() writes
    if (isDecided(found) && lane >= mostOf(found) && lane < count) cutNode(env, site.firstNode + lane, previousNode);
    if (lane == 0u) {
        UintBuf bounds = env.status.v[0].avoidBounds;
        atomicExchange(bounds.v[chunk], found);
        if (isDecided(found)) endDecision(env, chunk, found, count, again && spans.yields < spans.falls);
    }
    syncGroup();
}
