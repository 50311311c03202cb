#pragma once

// Nodes' frames and leaves' packed words, a lane of the processor's vectors each. The arithmetic is the kernels' text
// (expand_terminals.h), so the bits are the same.

#include <cstdint>

#include "runtime/core/lanes.hpp"

namespace espalier {

constexpr uint32_t kNodeLanes = 64, kLeafLanes = 64;

struct alignas(64) WideStems {
    using Floats = float[kNodeLanes];
    using Words = uint32_t[kNodeLanes];
    using Vectors = LaneVectors<kNodeLanes>;

    // In: as stemFrame takes them.
    Vectors before, at, after, branches;
    Words packedNormal, packedHeading;
    // Out: StemFrame.
    Vectors normal, heading;
    Words tangent;
};
// Of all lanes; what was never put is zero, and nobody's.
void frameStems(WideStems& stems);

struct alignas(64) WideLeaves {
    using Floats = float[kLeafLanes];
    using Words = uint32_t[kLeafLanes];

    // In: LeafDraft.
    Floats along, span, size, lift, turn, pitch, tint;
    Words mesh, colour, word;
    // Out: Leaf.
    Words packedPlace, packedPose, packedTint;
};
void packLeaves(WideLeaves& leaves);

}  // namespace espalier
