#pragma once

// How many lanes of a kernel share work where a GPU would wait long for one alone: their specialisation constant 5. A
// software device pays for each lane that has nothing to do.

#include "runtime/gpu/device.hpp"
#include "shaders/emit/emit_records.h"

namespace espalier {

// Lanes that go through a cell's items: cells may be coarse for what grows in them. As many rank a block's items.
inline uint32_t cellLanes(const Device& device) {
    return device.info().cpu ? 1 : 64;
}

// Lanes that put a cell's bins in order.
inline uint32_t sortLanes(const Device& device) {
    return device.info().cpu ? 8 : kCellBins;
}

}  // namespace espalier
