#pragma once

// Where an exact field turns: at the vertices of its singular elements, and where topology asks for more.

#include <functional>

#include "runtime/field/element_pull.hpp"
#include "runtime/field/mesh_topology.hpp"

namespace espalier {

struct SingularPlace {
    uint32_t vertex;  // an inner one; it shares no neighbour with another place's
    int turns;        // in N-ths of a whole turn
    bool operator==(const SingularPlace&) const = default;
};
struct SingularPlaces {
    std::vector<SingularPlace> all;
    int unasked = 0;  // turns that no element asks for, missing or too many, all pieces together
};

// smooth: gives a field, or an empty one, that says where what topology asks for lies best; called if there is such.
// Fails where the mesh has too few vertices for all of them.
Result<SingularPlaces> singularPlaces(const FieldMesh& mesh, const MeshTopology& topology, uint32_t symmetry,
                                      const std::vector<AskedElement>& elements, const std::function<Field()>& smooth);

}  // namespace espalier
