#pragma once

#include <vector>

#include "runtime/emit/terminals.hpp"
#include "shaders/render/roof_draw_records.h"

namespace espalier {

// What lies open where each kind's finest mesh is repeated cell by cell, from one side of a cell to the other: what far
// patterns are lit as. [kind * kProfileSteps + step]; flat and white where a kind has no mesh.
std::vector<RoofProfile> roofProfiles(const TerminalData& meshes);

}  // namespace espalier
