// Far twigs thinner than they can be drawn: of the faintest, whole chunks go, each on its own and fading, and what is
// left is drawn the stronger.
#ifndef ESPALIER_EMIT_SPAN_THINNING_H
#define ESPALIER_EMIT_SPAN_THINNING_H
#include "shaders/emit/glsl_names.h"

ESPALIER_BEGIN

CONST_FLOAT(kFaintest, 0.9f);   // share of a pixel that a twig covers at least
CONST_FLOAT(kGoing, 0.12f);     // share of the twigs that are fading at a time
CONST_FLOAT(kThinnest, 0.06f);  // in parts of the least radius that is drawn: thinner ones all go

// In [0, 1); key: of the chunk.
FN float twigOrder(u64 key) {
    uint h = (uint(key) ^ uint(key >> 32)) * 0x9E3779B1u;
    return float(h >> 8u) * 5.96046448e-8f;
}
// thin: radius in parts of the least that is drawn; order: the twig's.
FN bool spanIsKept(float thin, float order) { return order * kFaintest < thin; }
FN float spanFade(float thin, float order) {
    float strength = clamp((thin / kFaintest - order) / kGoing, 0.0f, 1.0f);
    return thin < 1.0f ? max(thin, kFaintest) * strength : 1.0f;
}

ESPALIER_END
#endif
