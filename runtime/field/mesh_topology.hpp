#pragma once

// How a mesh hangs together: its pieces, a tree over its triangles, and the ways around its handles and holes.

#include "runtime/field/field_mesh.hpp"

namespace espalier {

struct MeshPiece {
    std::vector<uint32_t> vertices;
    int euler = 0;       // its characteristic
    bool closed = true;  // without borders
};

// A number on an edge, of the half-edge that owns it; the other half-edge has its negative.
struct EdgeNumber {
    uint32_t halfEdge;
    double number;
};

struct MeshTopology {
    std::vector<MeshPiece> pieces;
    std::vector<uint32_t> pieceOf;  // [vertex]

    // A tree over the triangles of each piece, rooted outside where the piece has a border.
    std::vector<uint32_t> order;   // triangles, each behind its parent
    std::vector<uint32_t> upward;  // [triangle]: its half-edge towards its parent; kNoIndex: the root of a closed piece

    // Whole numbers on edges that cancel around every triangle, though they aren't differences of numbers at vertices.
    // All others are sums of these and of such differences: 2 for each handle, and 1 for each border but one.
    std::vector<std::vector<EdgeNumber>> loops;
};

MeshTopology topologyOf(const FieldMesh& mesh);

}  // namespace espalier
