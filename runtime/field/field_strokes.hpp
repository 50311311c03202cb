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
    // mostFelt: by how many vertices all strokes together may be felt, where a vertex counts for each point of a
    // stroke. The usual limit is a minute's work, and 4 GB where no stroke has two points.
    explicit FieldStrokes(const FieldMesh& mesh, size_t mostFelt = 100'000'000);
    ~FieldStrokes();
    // Changes directions, no lengths. Fails where strokes are felt by more vertices than may be, and where the
    // triangles under a smoothing brush are too bad.
    Status lay(const std::vector<FieldStroke>& strokes, Field& field);

  private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace espalier
