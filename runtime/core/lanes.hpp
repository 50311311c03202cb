#pragma once

// Loops over lanes: arrays of which an element each belongs to one of several things that are worked out alike. Where
// their body has no branches the compiler makes vectors of them; ESPALIER_LANES (platform.hpp) lets it make wider ones.

#include <cstdint>
#include <glm/vec3.hpp>

#include "runtime/core/platform.hpp"

namespace espalier {

template <uint32_t N>
struct LaneVectors {
    float x[N], y[N], z[N];
};

template <uint32_t N>
glm::vec3 vectorOf(const LaneVectors<N>& v, uint32_t lane) {
    return {v.x[lane], v.y[lane], v.z[lane]};
}

template <uint32_t N>
void put(LaneVectors<N>& to, uint32_t lane, glm::vec3 v) {
    to.x[lane] = v.x;
    to.y[lane] = v.y;
    to.z[lane] = v.z;
}

}  // namespace espalier
