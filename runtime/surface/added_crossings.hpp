#pragma once

// Crossings that a surface gets where it stands: contacts with other surfaces. They come and go as surfaces are moved,
// while what was baked stays as it is beneath them.

#include <span>
#include <vector>

#include "runtime/core/result.hpp"
#include "runtime/surface/surface.hpp"

namespace espalier {

// Per level, texels in texelIndex order, ascending.
using TexelSets = std::vector<std::vector<uint32_t>>;

// What of a level's texels is other than baked. Indices are in texelIndex order, ascending.
struct LevelPatch {
    std::vector<uint32_t> texels;
    std::vector<uint32_t> bits;   // Texel::bits of each
    std::vector<uint32_t> heads;  // its crossingHead
    std::vector<uint32_t> added;  // what follows the level's own crossingRefs
};

// The texels of a level that list one of the crossings by the baker's rule, ascending.
std::vector<uint32_t> texelsPassed(const SurfaceLevelData& level, std::span<const Crossing> crossings);

// One patch a level, in which `added` are listed by the texels that they pass (by the baker's rule, numbered from
// data.crossings.size() on), clearances tell of them, and the `buried` texels of each level are kTexelLink, with their
// clearance: a walk that is past the texels beside a contact finds no ground there. Costs no more than the texels
// within 32 of a crossing. A texel lists 255 crossings at most; what more meets there is left out. Fails where a level
// would list 2^24.
Result<std::vector<LevelPatch>> patchLevels(const SurfaceData& data, std::span<const Crossing> added,
                                            const TexelSets& buried = {});

// Puts a patch into a level's own arrays: for walks on the CPU.
void applyPatch(const LevelPatch& patch, SurfaceLevelData& level);

}  // namespace espalier
