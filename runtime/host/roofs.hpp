#pragma once

// The kernel of roofs as native code: its own text compiled as C++ (-ffp-contract=off), so it leaves the same bits.

#include "runtime/core/jobs.hpp"
#include "shaders/shared/roof_records.h"

namespace espalier {

// Derives the shapes of wave env.wave, as derive.comp does. All addresses are pointers here; env.shapes are this wave's
// shapes and env.next has room for the next wave's. Nothing else may use that memory meanwhile.
void deriveRoofsNative(RoofEnv env, Crew& crew);

}  // namespace espalier
