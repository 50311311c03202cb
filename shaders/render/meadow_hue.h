// What the meadow is like over tens of metres, for the ground's pixels and for what grows on it. broad: the noise tile's
// four sums, -1 to 1, at place / kMeadowTile.
#ifndef ESPALIER_RENDER_MEADOW_HUE_H
#define ESPALIER_RENDER_MEADOW_HUE_H
#include "shaders/shared/language.h"

ESPALIER_BEGIN

CONST_FLOAT(kMeadowTile, 97.0f);   // metres
CONST_FLOAT(kMeadowDry, 0.28f);    // share of grass that is dry, in the mean
CONST_FLOAT(kMeadowMostDry, 0.75f);

FN float broadDryness(IN(vec4) broad) { return 0.75f * broad.x; }
// Here thicker, there thinner: a factor.
FN float broadGrowth(IN(vec4) broad) { return 1.0f + 0.6f * broad.z + 0.25f * broad.x; }
// 0: clover and sorrel, 1: where it was cut earlier.
FN float broadSwathe(IN(vec4) broad) { return 0.5f + 1.2f * broad.w + 0.7f * broad.x; }
FN vec3 swatheTint(float swathe) {
    return vec3(0.66f, 0.82f, 0.74f) * (1.0f - swathe) + vec3(1.20f, 1.10f, 0.86f) * swathe;
}

ESPALIER_END
#endif
