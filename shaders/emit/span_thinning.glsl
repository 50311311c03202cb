// Far twigs thinner than they can be drawn: of the faintest, whole chunks go, each on its own and fading, and what is
// left is drawn the stronger.
#ifndef ESPALIER_EMIT_SPAN_THINNING_GLSL
#define ESPALIER_EMIT_SPAN_THINNING_GLSL
#include "shaders/emit/span_load.h"

const float kFaintest = 0.9;   // share of a pixel that a twig covers at least
const float kGoing = 0.12;     // share of the twigs that are fading at a time

// In [0, 1); key: of the chunk.
float twigOrder(u64 key) {
    uint h = (uint(key) ^ uint(key >> 32)) * 0x9E3779B1u;
    return float(h >> 8u) * 5.96046448e-8;
}
// thin: radius in parts of the least that is drawn.
bool spanIsKept(float thin, u64 key) { return twigOrder(key) * kFaintest < thin; }
float spanFade(float thin, u64 key) {
    float strength = clamp((thin / kFaintest - twigOrder(key)) / kGoing, 0.0, 1.0);
    return thin < 1.0 ? max(thin, kFaintest) * strength : 1.0;
}
#endif
