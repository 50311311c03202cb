#pragma once

// What surfaces that come, go and move mean for the plants that stand on them.

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

struct EspContext;

namespace espalier {

// What has become of a surface since the last growth; of several changes the one that concerns more plants.
enum class SurfaceChange : uint8_t {
    none,
    shifted,  // it alone has moved without turning: of its plants only those change that ask where they stand
    turned,   // it alone has moved: only those change that ask for anything of the world
    ground,   // other ground can be reached from it, it has another scale, or it is gone: all change
};

// [instance], since the last growth; those beyond its end haven't changed.
using SurfaceChanges = std::vector<SurfaceChange>;

// What a move by itself means: plants stand in their surface's own space, in which nothing moves.
SurfaceChange changeOfMove(const glm::mat4& before, const glm::mat4& after);
// The context's changes with one more. Surfaces that contacts join to the instance, as they were found last, have other
// ground too.
SurfaceChanges withChange(const EspContext& context, uint32_t instance, SurfaceChange change);
// Once contacts have been found anew: notes for growth the seeds whose plants the changes concern. All other plants
// stand as they are.
void noteSurfaceChanges(EspContext& context);

}  // namespace espalier
