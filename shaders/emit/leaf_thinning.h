// Far canopies are drawn with fewer, larger leaves: each goes on its own, by its hash, so that nothing pops at once.
#ifndef ESPALIER_EMIT_LEAF_THINNING_H
#define ESPALIER_EMIT_LEAF_THINNING_H
#include "shaders/emit/glsl_names.h"

ESPALIER_BEGIN

FN float leafShare(IN(EmitView) view, float sizePixels) {
    float x = sizePixels / view.wholePixels;
    return clamp(x * x, view.leastShare, 1.0f);
}
FN bool leafIsKept(float share, uint hash) { return float(hash >> 8u) * 5.96046448e-8f < share; }
// What is left covers the same area.
FN float leafGrowth(float share) { return inversesqrt(share); }

ESPALIER_END
#endif
