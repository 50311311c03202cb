#pragma once

// What the content tool's files reckon with. Pure functions.

#include <algorithm>
#include <cstdint>
#include <glm/glm.hpp>

namespace espalier::content {

constexpr float kPi = 3.14159265f;

inline float saturate(float x) {
    return glm::clamp(x, 0.0f, 1.0f);
}
inline uint8_t toByte(float x) {
    return uint8_t(saturate(x) * 255.0f + 0.5f);
}
inline float ramp(float low, float high, float x) {
    return glm::smoothstep(low, high, x);
}

// From p to the nearest point between a and b.
inline float segmentDistance(glm::vec2 p, glm::vec2 a, glm::vec2 b) {
    const glm::vec2 d = b - a;
    return glm::distance(p, a + d * saturate(glm::dot(p - a, d) / std::max(glm::dot(d, d), 1e-12f)));
}

}  // namespace espalier::content
