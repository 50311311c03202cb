#pragma once

// Strokes of brushes over a field: a comb drags its directions along, a smoothing brush lets them relax.

#include <memory>
#include <vector>

#include "runtime/field/field.hpp"

namespace espalier {

// Lays strokes over fields of one mesh, one after the other. What a stroke does to vertices doesn't depend on the field
// below it, so it is kept while the stroke stays or grows longer. The result is the same to the bit as that of a new
// one. mesh: outlives this. One thread at a time.
class FieldStrokes {
  public:
    explicit FieldStrokes(const FieldMesh& mesh);
    ~FieldStrokes();
    // Changes directions, no lengths. False: the triangles under a smoothing brush are too bad.
    bool lay(const std::vector<FieldStroke>& strokes, Field& field);

  private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace espalier
