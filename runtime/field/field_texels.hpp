#pragma once

#include <vector>

#include "runtime/field/field.hpp"
#include "shaders/shared/field_records.h"

namespace espalier {

// A field over the texels of a surface's finest level, whose aux must be there. mesh: made from the same surface.
std::vector<FieldTexel> fieldTexels(const SurfaceData& surface, const FieldMesh& mesh, const Field& field);

}  // namespace espalier
