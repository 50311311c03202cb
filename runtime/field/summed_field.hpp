#pragma once

#include "runtime/field/element_pull.hpp"

namespace espalier {

// A sum of radial basis functions and Laplacian smoothing (Li 2011 §4.2), for comparison with the solve. pull: what
// elements and the drift ask for.
Field summedField(const FieldMesh& mesh, uint32_t symmetry, const Pull& pull, uint32_t passes);

}  // namespace espalier
