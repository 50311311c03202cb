#pragma once

// The tiles of a watched picture that are to be drawn again, taken by native code.

#include "shaders/emit/emit_records.h"

namespace espalier {

// Leaves in the tiles that `push` points to what take_tiles.comp would. Nothing may use them meanwhile.
void takeTilesNative(const TakePush& push);

}  // namespace espalier
