// Far canopies are drawn with fewer, larger leaves: each goes on its own, by its hash, so that nothing pops at once.
#ifndef ESPALIER_EMIT_LEAF_THINNING_GLSL
#define ESPALIER_EMIT_LEAF_THINNING_GLSL
#include "shaders/emit/emit_records.h"

float leafShare(EmitView view, float sizePixels) {
    float x = sizePixels / view.wholePixels;
    return clamp(x * x, view.leastShare, 1.0);
}
bool leafIsKept(float share, uint hash) { return float(hash >> 8u) * 5.96046448e-8 < share; }
// What is left covers the same area.
float leafGrowth(float share) { return inversesqrt(share); }
#endif
