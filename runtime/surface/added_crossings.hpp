#pragma once

// Crossings that a surface gets where it stands: contacts with other surfaces. They come and go as surfaces are moved,
// while what was baked stays as it is beneath them.

#include <span>
#include <vector>

#include "runtime/core/result.hpp"
#include "runtime/surface/surface.hpp"

namespace espalier {

// What of a level's texels is other than baked. Indices are in texelIndex order, ascending.
struct LevelPatch {
    std::vector<uint32_t> texels;
    std::vector<uint32_t> bits;   // Texel::bits of each
    std::vector<uint32_t> heads;  // its crossingHead
    std::vector<uint32_t> added;  // what follows the level's own crossingRefs
};

// One patch a level, in which `added` are listed by the texels that they pass (by the baker's rule, numbered from
// data.crossings.size() on) and clearances tell of them. Costs no more than the texels within 32 of a crossing.
// A texel lists 255 crossings at most; what more meets there is left out. Fails where a level would list 2^24.
Result<std::vector<LevelPatch>> patchLevels(const SurfaceData& data, std::span<const Crossing> added);

// Puts a patch into a level's own arrays: for walks on the CPU.
void applyPatch(const LevelPatch& patch, SurfaceLevelData& level);

}  // namespace espalier
