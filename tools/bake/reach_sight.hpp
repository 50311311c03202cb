#pragma once

#include <array>

#include "tools/bake/bake_mesh.hpp"

namespace espalier::bakery {

// Asks whether places of a finished surface are seen from outside, and not only from below the model's foot, as the
// insides of attics, of boxes that others close, and of houses without a floor aren't. What it is given has to outlive
// it.
class Sight {
  public:
    Sight(const BakeMesh& mesh, const MeshTree& drawn, const SurfaceData& surface);
    // cell: an inner texel of the finest level, as texelIndex has it.
    bool sees(uint32_t cell) const;

  private:
    static constexpr int kRays = 96;
    bool endsBelow(glm::dvec3 from, glm::dvec3 ray) const;

    const BakeMesh& mesh_;
    const MeshTree& drawn_;
    const SurfaceData& surface_;
    std::array<glm::dvec3, kRays> rays_;
};

}  // namespace espalier::bakery
