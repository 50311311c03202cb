#pragma once

#include <memory>

#include "runtime/field/field.hpp"

namespace espalier {

// Designs one field of a mesh again and again. What only depends on where the elements are is kept, so that an element
// that turns costs a back-substitution. Every design gives the same bits as a new solver would give. mesh: outlives the
// solver. One thread at a time.
class FieldSolver {
  public:
    explicit FieldSolver(const FieldMesh& mesh);
    ~FieldSolver();
    // See designField.
    Result<Field> design(const FieldDesign& design);

  private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace espalier
