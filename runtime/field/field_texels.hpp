#pragma once

#include <vector>

#include "runtime/field/field.hpp"
#include "shaders/shared/field_records.h"

namespace espalier {

// Lays fields over the texels of a surface's finest level, whose aux must be there. Keeps how each triangle lies, so
// that another field of the same mesh costs no angles. surface, mesh (made from it): outlive this.
class FieldSampling {
  public:
    FieldSampling(const SurfaceData& surface, const FieldMesh& mesh);
    std::vector<FieldTexel> texels(const Field& field) const;

  private:
    // A triangle's plane, and the directions of its corners' axes in it.
    struct Plane {
        glm::vec3 axis{0}, left{0};
        std::array<std::complex<double>, 3> corners{};
    };

    const SurfaceData& surface_;
    const FieldMesh& mesh_;
    std::vector<Plane> planes_;  // [triangle of the surface]
};

}  // namespace espalier
