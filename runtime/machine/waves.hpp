#pragma once

// The waves of a growth on the host. Growth begins with some shapes in the first wave, and each wave queues shapes for
// the next one, until one is empty.

#include <algorithm>
#include <span>
#include <vector>

#include "shaders/shared/waves.h"

namespace espalier {

// `waves` of them, of which the first has `shapes` waiting, for `groups` groups.
inline std::vector<Wave> wavesBefore(size_t waves, uint32_t shapes, uint32_t groups) {
    std::vector<Wave> all(waves, Wave{0, {0, 1, 1}, 0, 0, 0, 0});
    all[0].count = shapes;
    all[0].groups[0] = groups;
    return all;
}
// How many waves there were before the first that is empty.
inline uint32_t wavesOf(std::span<const Wave> waves) {
    return uint32_t(std::ranges::find(waves, 0u, &Wave::count) - waves.begin());
}
// The most shapes that waited in one.
inline uint32_t widestOf(std::span<const Wave> waves) {
    return waves.empty() ? 0 : std::ranges::max(waves, {}, &Wave::count).count;
}

}  // namespace espalier
