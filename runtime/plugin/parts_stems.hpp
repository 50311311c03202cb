#pragma once

// Bark as one tube along each branch.

#include <vector>

#include "runtime/plugin/parts.hpp"
#include "shaders/emit/bark_ring.h"

namespace espalier {

// A ring around a stem, and what holds there.
struct StemRing {
    BarkRing ring;
    float metres = 0;  // along the branch
    float wind = 0, age = 0;
};
// Rings of a branch where it has bark without a gap.
using StemRun = std::vector<StemRing>;

float thickest(const StemRun& run);  // radius, metres

// The tubes along `runs` in one mesh that differs from them by up to `error` metres. 0: every ring, of as many sides as
// the kernel writes. thinOut: what is thinner than that isn't there.
PartLevel stemLevel(const std::vector<StemRun>& runs, float error, bool thinOut);

}  // namespace espalier
