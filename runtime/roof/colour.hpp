#pragma once

#include <cmath>
#include <cstdint>

namespace espalier {

// Colours of houses as plans have them, 8 bits of sRGB a channel, and linear, 0 to 1.
inline float fromSrgb(uint32_t byte) {
    const float v = float(byte) / 255;
    return v <= 0.04045f ? v / 12.92f : std::pow((v + 0.055f) / 1.055f, 2.4f);
}
inline uint32_t toSrgb(float linear) {
    const float c = linear <= 0.0031308f ? linear * 12.92f : 1.055f * std::pow(linear, 1 / 2.4f) - 0.055f;
    return uint32_t(std::lround(c * 255));
}

}  // namespace espalier
