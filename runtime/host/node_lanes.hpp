#pragma once

// Elements of the graph that native code works out side by side. Loops over lanes go over arrays of their own: of what
// lies behind an address a compiler can't tell that it is apart.

#include <cstring>

#include "runtime/core/lanes.hpp"
#include "shaders/shared/node_records.h"

namespace espalier {

using NodeLanes = LaneVectors<kNodeLanes>;

inline void load(NodeLanes& l, const NodePlanes& from, uint32_t at, uint32_t plane = 0) {
    std::memcpy(l.x, planeOf(from, plane).v + at, sizeof l.x);
    std::memcpy(l.y, planeOf(from, plane + 1).v + at, sizeof l.y);
    std::memcpy(l.z, planeOf(from, plane + 2).v + at, sizeof l.z);
}
inline void store(const NodeLanes& l, const NodePlanes& to, uint32_t at, uint32_t plane = 0) {
    std::memcpy(planeOf(to, plane).v + at, l.x, sizeof l.x);
    std::memcpy(planeOf(to, plane + 1).v + at, l.y, sizeof l.y);
    std::memcpy(planeOf(to, plane + 2).v + at, l.z, sizeof l.z);
}

}  // namespace espalier
