// Degrees of scene files <-> radians, to the last bit.
#include <cmath>
#include <numbers>

#include "tools/scene/scene_file.hpp"

namespace espalier::scene {
namespace {

constexpr float kPi = std::numbers::pi_v<float>;

}  // namespace

float turnOfDegrees(float degrees) {
    return degrees * (kPi / 180);
}

float fovOfDegrees(float degrees) {
    return degrees * kPi / 180;
}

float degreesOf(float angle, float (*read)(float degrees)) {
    const float near = angle * (180 / kPi);
    float low = near, high = near;
    for (int i = 0; i < 4; ++i) {
        for (float degrees : {low, high})
            if (read(degrees) == angle) return degrees;
        low = std::nextafter(low, -1e9f);
        high = std::nextafter(high, 1e9f);
    }
    return near;
}

}  // namespace espalier::scene
