#pragma once

// The small scene that a device's self-check grows and draws. It is made in code: a device is checked before a host
// has loaded anything, and the scene has to stay the same whatever the baker and the content become.

#include <string_view>
#include <vector>

#include "runtime/emit/terminals.hpp"
#include "runtime/grammar/grammar.hpp"
#include "runtime/roof_growth/atoms.hpp"
#include "runtime/surface/surface.hpp"

namespace espalier::selfcheck {

// A floor and a wall of one metre a side, a chart each, joined by a seam; all other borders are open. The floor lies in
// y = 0 from z = 0 to 1, the wall stands in z = 0.
SurfaceData step();

// Seeds on the floor that grow towards the wall, up it and into branches; leaves on all of them.
std::vector<Seed> seedsOnFloor(uint32_t count);
Result<RuleMap> plantRules();

// Bark as a prism and a leaf of one quad.
TerminalData plantMeshes();

// One house with a hipped roof, covered with tiles of which the outline clips some.
RoofTables house();
Result<RuleMap> roofRules();
TerminalData roofTiles();

}  // namespace espalier::selfcheck
