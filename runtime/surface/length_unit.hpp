#pragma once

#include <algorithm>

namespace espalier {

// What counts as a metre: a metre, unless all models are far too small or too large for that. Then the longest side of
// the largest, or of the smallest, counts as six. least, most: the models' longest sides, the shortest and the longest.
inline float lengthUnit(float least, float most) {
    constexpr float kSmall = 1, kLarge = 200;  // metres
    if (most < kSmall) return std::max(most, 1e-6f) / 6;
    return least >= kLarge ? least / 6 : 1.0f;
}

}  // namespace espalier
