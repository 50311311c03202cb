#pragma once

#include <vector>

#include "runtime/field/field_mesh.hpp"

namespace espalier {

// Geodesic polar coordinates about a vertex (Li 2011 §4.2): how far each vertex is, in metres, and the angle at the
// centre, in the centre's own measure of angles, at which the shortest way to the vertex begins.
struct PolarMap {
    std::vector<double> distance;   // infinity: beyond the reach, or not connected
    std::vector<double> angle;      // radians; meaningless where the distance is 0 or infinite
    std::vector<uint32_t> reached;  // vertices of finite distance, the nearest first
};

// By a front of triangles that are laid flat one after another. reach: metres.
PolarMap polarMap(const FieldMesh& mesh, uint32_t centre, double reach);
// The same in the place of an earlier map of this mesh, or of an empty one: takes as long as both reach.
void polarMap(const FieldMesh& mesh, uint32_t centre, double reach, PolarMap& map);

}  // namespace espalier
