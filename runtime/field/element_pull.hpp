#pragma once

// What the elements and the drift of a design ask for at each vertex, and how strongly.

#include <memory>

#include "runtime/field/field.hpp"
#include "runtime/field/polar_map.hpp"

namespace espalier {

struct Pull {
    std::vector<double> weight;
    std::vector<std::complex<double>> sum;  // of wishes, as N-th powers, times weights

    explicit Pull(size_t vertices) : weight(vertices, 0), sum(vertices, 0) {}
};

// Where an element is felt and what it asks for there, but for its direction.
struct FeltElement {
    FieldElement element;
    uint32_t centre = 0;             // the nearest vertex
    std::vector<uint32_t> vertices;  // the nearest first,
    size_t within = 0;               // so many of them within its radius
    std::vector<double> weights;
    std::vector<std::complex<double>> wishes;
};

struct AskedElement {
    const FeltElement* felt;
    std::complex<double> turn;  // of all of its wishes, because of the direction that the element has now
};

// Those of one mesh and one symmetry. They are kept while their elements only turn.
class FeltElements {
  public:
    const FeltElement& of(const FieldMesh& mesh, uint32_t symmetry, const FieldElement& element);
    void keepOnly(const std::vector<FieldElement>& elements);

  private:
    std::vector<std::unique_ptr<FeltElement>> all_;
};

uint32_t nearestVertex(const FieldMesh& mesh, const glm::dvec3& place);

// carried: [vertex], the angle that parallel transport from the map's centre adds along the shortest way there; of
// vertices that the map doesn't reach it stays as it was.
void carryAngles(const FieldMesh& mesh, const PolarMap& map, std::vector<double>& carried);

AskedElement askedElement(const FieldMesh& mesh, uint32_t symmetry, const FeltElement& felt,
                          const FieldElement& element);
void addElement(const AskedElement& asked, Pull& pull);
// Along the whole of the surface a little to where the design drifts.
void addDrift(const FieldMesh& mesh, const FieldDesign& design, Pull& pull);

}  // namespace espalier
