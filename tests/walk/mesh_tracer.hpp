#pragma once

// Straightest geodesics over a triangle mesh in double precision: the oracle for walks on real models. Shares no
// code with the walk or the baker.

#include <optional>
#include <vector>

#include "tests/walk/judge.hpp"

namespace espalier::walktest {

class MeshTracer {
  public:
    // Triangles with walk UVs; copied as far as needed. Vertices are welded by equal positions.
    MeshTracer(const std::vector<DrawVertex>& vertices, const std::vector<uint32_t>& indices);

    // Straight ahead from barycentric `at` of a triangle; `direction` is laid into its plane. None where the way
    // meets a border, an edge of more than two triangles, a degenerate triangle, or runs into a vertex.
    std::optional<Vec3> trace(uint32_t triangle, Vec3 at, Vec3 direction, double length) const;

    // `count` walks from points spread evenly over the model's area, in random directions, for a surface baked
    // from it. Left out: starts whose texture coordinate shows the surface at another place
    // (overlapping charts) and walks that trace can't finish.
    std::vector<Trial> trials(const SurfaceData& surface, int count, double length, uint64_t seed) const;

  private:
    Vec3 corner(uint32_t triangle, int k) const { return positions_[welded_[triangle * 3 + uint32_t(k)]]; }

    std::vector<Vec3> positions_;   // of welded vertices
    std::vector<uint32_t> welded_;  // three a triangle
    std::vector<Vec2> uvs_;         // three a triangle
    std::vector<int64_t> mates_;    // of half-edge (triangle * 3 + k), -1: border or not manifold
    std::vector<double> area_;      // running sums
};

}  // namespace espalier::walktest
