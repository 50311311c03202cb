#pragma once

#include "tools/bake/bake.hpp"

namespace espalier {

// The bake as Buron 2015 §4 describes it, written for comparison only: one level, positions and chart ids
// rasterised, and for each pixel on a chart's outer boundary the nearest inner border pixel of another chart,
// found in a kd-tree. No welding, no seam maps, no further levels. Returns the number of links.
size_t paperBake(const Model& model, uint32_t resolution);

}  // namespace espalier
