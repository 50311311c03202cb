#pragma once

#include <cmath>

namespace espalier {

// A channel of a colour, 0 to 1, by sRGB's curve to linear and back.
inline float linearOfSrgb(float v) {
    return v <= 0.04045f ? v / 12.92f : std::pow((v + 0.055f) / 1.055f, 2.4f);
}
inline float srgbOfLinear(float v) {
    return v <= 0.0031308f ? v * 12.92f : 1.055f * std::pow(v, 1 / 2.4f) - 0.055f;
}

}  // namespace espalier
