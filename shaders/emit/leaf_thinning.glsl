// Far canopies are drawn with fewer, larger leaves: each goes on its own, by its hash, so that nothing pops at once.
#ifndef ESPALIER_EMIT_LEAF_THINNING_GLSL
#define ESPALIER_EMIT_LEAF_THINNING_GLSL
#include "shaders/emit/leaf_place.h"

const float kWholePixels = 8.0;    // leaves of at least this many pixels are all drawn
const float kLeastShare = 0.12;

float leafShare(float sizePixels) {
    float x = sizePixels / kWholePixels;
    return clamp(x * x, kLeastShare, 1.0);
}
bool leafIsKept(float sizePixels, uint hash) {
    return float(hash >> 8u) * 5.96046448e-8 < leafShare(sizePixels);
}
// What is left covers the same area.
float leafGrowth(float sizePixels) { return inversesqrt(leafShare(sizePixels)); }
#endif
