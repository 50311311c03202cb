#pragma once

// What surfaces that come, go and move mean for the plants that stand on them.

#include <cstdint>
#include <vector>

struct EspContext;

namespace espalier {

// What has become of a surface since the last growth; of several changes the one that concerns more plants.
enum class SurfaceChange : uint8_t {
    none,
    ground,  // other ground can be reached from it, it has another scale, or it is gone
};

// [instance], since the last growth; those beyond its end haven't changed.
using SurfaceChanges = std::vector<SurfaceChange>;

// The context's changes with one more. Surfaces that contacts join to the instance, as they were found last, have other
// ground too.
SurfaceChanges withChange(const EspContext& context, uint32_t instance, SurfaceChange change);
// Once contacts have been found anew: notes for growth the seeds whose plants the changes concern. All other plants
// stand as they are.
void noteSurfaceChanges(EspContext& context);

}  // namespace espalier
