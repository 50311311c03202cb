#pragma once

// What .mtl libraries do to pictures.

#include <optional>

#include "tools/bake/import.hpp"

namespace espalier::import {

// Does it look like a map of normals in tangent space? Heights and colours don't.
bool holdsNormals(const Picture& picture);

// A picture of colours (null: white) whose alpha is what another one says: by its own alpha where it has some, else by
// its brightness. Nothing: it takes more memory than the intake allows.
std::optional<Picture> withCutOut(const Picture* colour, const Picture& shape, Intake& intake);

}  // namespace espalier::import
