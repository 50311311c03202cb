// Far twigs thinner than they can be drawn: of the faintest, whole chunks go, each on its own and fading, and what is
// left is drawn the stronger.
#ifndef ESPALIER_EMIT_SPAN_THINNING_GLSL
#define ESPALIER_EMIT_SPAN_THINNING_GLSL
#include "shaders/emit/emit_records.h"

const float kFaintest = 0.9;   // share of a pixel that a twig covers at least
const float kGoing = 0.12;     // share of the twigs that are fading at a time
const float kThinnest = 0.06;  // in parts of the least radius that is drawn: thinner ones all go

// In [0, 1); key: of the chunk.
float twigOrder(u64 key) {
    uint h = (uint(key) ^ uint(key >> 32)) * 0x9E3779B1u;
    return float(h >> 8u) * 5.96046448e-8;
}
// thin: radius in parts of the least that is drawn; order: the twig's.
bool spanIsKept(float thin, float order) { return order * kFaintest < thin; }
float spanFade(float thin, float order) {
    float strength = clamp((thin / kFaintest - order) / kGoing, 0.0, 1.0);
    return thin < 1.0 ? max(thin, kFaintest) * strength : 1.0;
}
#endif
