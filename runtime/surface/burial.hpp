#pragma once

// Which texels of a placed surface others bury: those within their solid bodies, or beneath faces that lie on them,
// unless ground leads there past all contacts, as through a door. Found for two surfaces at a time, kept while both
// stand where they do, and put together for a surface when something has changed.

#include "runtime/surface/added_crossings.hpp"
#include "runtime/surface/contact_ground.hpp"

namespace espalier {

// The inner texels of `data`, all levels of which are in memory, that the bodies of `by` hide; `own` is its ground.
// contacts: the crossings that lead from own to by. Texels that these pass hide nothing and count as seen. yields: of
// equal faces in one place own's is hidden. Costs little more than the tiles of 8×8 texels that surfaces of `by` pass.
TexelSets hiddenTexels(const SurfaceData& data, const PlacedGround& own, const PlacedGround& by,
                       std::span<const Crossing> contacts, bool yields);

// Adds texels to sets, level by level.
void addTo(TexelSets& sets, const TexelSets& more);

// Those of the hidden texels from which no ground that is seen can be gone to, over the chart and its seams, without
// meeting one of `added`, all contacts of the surface with others.
TexelSets buriedTexels(const SurfaceData& data, const TexelSets& hidden, std::span<const Crossing> added);

}  // namespace espalier
