#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "runtime/surface/surface.hpp"

namespace espalier {

// Height along `up`, in object space, above which a mesh is solid: every edge there has as many faces that run along it
// one way as the other, and every piece is turned outward. Who looks from above that height, and sees nothing of what
// lies below it, sees no face's back unless from inside the solid. -infinity: the mesh is solid as a whole; +infinity:
// it can't be told, or a piece is turned inside out. indices: triangles; corners are the same where their positions are
// the same to the bit.
float solidAbove(std::span<const DrawVertex> vertices, std::span<const uint32_t> indices, glm::vec3 up);

}  // namespace espalier
