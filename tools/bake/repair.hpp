#pragma once

// Mends that come before charts are cut.

#include <optional>

#include "tools/bake/bake_mesh.hpp"

namespace espalier::bakery {

// Turns triangles so that neighbours over an edge of two agree about outside, by the majority of area, by the model's
// normals where it has some; closed pieces of models without normals face outward. Returns the model so turned, with
// a warning that says how much, or nothing when all is well. What can't agree (a Möbius strip) is named and left.
std::optional<Model> repairOrientation(const Model& model, const BakeMesh& mesh, std::vector<Diagnostic>& warnings);

}  // namespace espalier::bakery
