#pragma once

// Where in a pixel pictures lie whose mean is a smooth one: the points of the evenest sequence, of which each first
// part is even too. The first is the pixel's middle.

#include <cmath>
#include <cstdint>

#include "plugin_api/espalier.h"

namespace espalier::scene {

// The camera of picture `which` of a mean, of pictures of that size.
inline EspCamera jittered(EspCamera camera, uint32_t which, uint32_t width, uint32_t height) {
    constexpr float kAcross = .7548777f, kUp = .5698403f;
    const auto from = [&](float step) { return std::fmod(.5f + float(which) * step, 1.f) - .5f; };
    camera.shift[0] += 2 * from(kAcross) / float(width);
    camera.shift[1] += 2 * from(kUp) / float(height);
    return camera;
}

}  // namespace espalier::scene
