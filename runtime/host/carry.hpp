#pragma once

// Bound growth carried over as native code, in the memory that kernels use.

#include "shaders/emit/emit_records.h"

namespace espalier {

// Gives what is bound the numbers that nodesWent and leavesWent say, which are never higher; null: they stay. All in
// place, but for the order of items: its cells come to orderTo, with new room. Nothing may use any of it meanwhile.
void carryNative(const CarryPush& push, unsigned threads = 0);

}  // namespace espalier
