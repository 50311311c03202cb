#pragma once

// The mesh on which tangent fields are designed: a surface's triangles with welded corners, and the angles at which
// edges leave each vertex.

#include <array>
#include <complex>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "runtime/surface/surface.hpp"

namespace espalier {

// A manifold mesh, perhaps with borders. Half-edge 3 t + k leads from corner k of triangle t to the next corner.
//
// A tangent direction at a vertex is an angle, counterclockwise as seen from outside, from the vertex's reference: the
// half-edge first[v]. The angles of all corners of an inner vertex are scaled to add up to 2 pi (Knöppel et al. 2013,
// "Globally optimal direction fields", §3), so that the indices of a field's singularities on a closed mesh add up to
// its Euler characteristic.
struct FieldMesh {
    std::vector<glm::dvec3> positions;               // object space, metres
    std::vector<std::array<uint32_t, 3>> triangles;  // counterclockwise as seen from outside
    std::vector<uint32_t> twin;                      // [half-edge]: the other triangle's; kNoIndex: a border
    std::vector<uint32_t> first;                     // [vertex]: a half-edge that leaves it; of a border, the first
    std::vector<double> angle;                       // [half-edge]: at which it leaves its vertex, radians
    std::vector<glm::dvec3> normals;                 // [vertex]: unit, outward
    std::vector<glm::dvec3> axes;                    // [vertex]: unit tangent, the direction of angle 0
    std::vector<double> areas;                       // [vertex]: a third of its triangles', m²
    std::vector<bool> border;                        // [vertex]
    double radius = 0;                               // half the diagonal of its bounds, metres

    // [triangle of the surface]: the mesh's; kNoIndex: it has no area.
    std::vector<uint32_t> triangleOf;
    // [mesh triangle][corner]: which corner of the surface's triangle, by the order of its UVs.
    std::vector<std::array<uint8_t, 3>> cornerOf;

    uint32_t from(uint32_t halfEdge) const { return triangles[halfEdge / 3][halfEdge % 3]; }
    uint32_t to(uint32_t halfEdge) const { return from(next(halfEdge)); }
    static uint32_t next(uint32_t halfEdge) { return halfEdge % 3 == 2 ? halfEdge - 2 : halfEdge + 1; }
    static uint32_t previous(uint32_t halfEdge) { return halfEdge % 3 == 0 ? halfEdge + 2 : halfEdge - 1; }
    // What is to be added to the angle of a direction at from(h), moved in parallel along h, to get its angle at to(h).
    double transport(uint32_t halfEdge) const;
    // The angle between a half-edge and the next one around its vertex, in the vertex's measure.
    double tip(uint32_t halfEdge) const;
    // The curvature within a triangle: by how much its three tips exceed half a turn. Those of a closed mesh add up to
    // 2 pi times its Euler characteristic.
    double curvature(uint32_t triangle) const;
    // Of an edge's one or two half-edges exactly one.
    bool ownsEdge(uint32_t halfEdge) const { return twin[halfEdge] == kNoIndex || twin[halfEdge] > halfEdge; }
    // How strongly the ends of a half-edge's edge are bound to each other: half of both cotangents, but kept above
    // zero, so that energies have one least value whatever the triangles' shapes.
    double edgeWeight(uint32_t halfEdge) const;
    // The direction of an angle at a vertex, in object space; unit.
    glm::dvec3 direction(uint32_t vertex, double angle) const;
    // And back: the angle of a direction laid into the vertex's tangent plane.
    double angleOf(uint32_t vertex, const glm::dvec3& direction) const;
    // V - E + F of the vertices that triangles use.
    int eulerCharacteristic() const;
};

// Welds corners that are nearer than a millionth of the surface's radius. Where more than two triangles meet at an
// edge, or a vertex joins several fans, these come apart.
FieldMesh makeFieldMesh(const SurfaceData& surface);
// The same from plain triangles: counterclockwise as seen from outside.
FieldMesh makeFieldMesh(std::vector<glm::dvec3> corners);

}  // namespace espalier
