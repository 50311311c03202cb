#pragma once

// Fields that have exactly the singularities that elements name: trivial connections (Crane, Desbrun, Schröder 2010).

#include <functional>

#include "runtime/field/element_pull.hpp"

namespace espalier {

// Keeps what depends on the mesh alone and, while the elements only turn, on where they are. mesh: outlives this.
class ExactField {
  public:
    explicit ExactField(const FieldMesh& mesh);
    ~ExactField();

    // A field that has the singularities of the elements and no others but for those that topology asks for: on each
    // closed piece of the mesh all turns add up to N times its Euler characteristic. What the elements leave over is
    // put where the smooth field turns by itself, far from the elements. elements: all of the design's. all: what they
    // and the drift ask for. smooth: gives the smooth field if it is needed; an empty one where there is none. Fails
    // where the mesh has too few vertices.
    Result<Field> design(uint32_t symmetry, const std::vector<AskedElement>& elements, const Pull& all,
                         const std::function<Field()>& smooth);

  private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace espalier
