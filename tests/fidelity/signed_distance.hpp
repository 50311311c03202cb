#pragma once

// The distance to a triangle mesh with its sign, in double precision: an oracle that shares nothing with the baker, the
// walk or the drawing.

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

namespace espalier::fidelitytest {

class SignedDistance {
  public:
    // Three indices a triangle. Vertices at equal positions are one; triangles without area are left out.
    SignedDistance(const std::vector<glm::vec3>& positions, const std::vector<uint32_t>& indices);

    // From the nearest point of the mesh to `point`: positive on the side that the triangles face, negative behind
    // them. The side is told by the pseudo-normal of the face, edge or corner that is nearest, so that it is right
    // for points beside creases and corners too.
    double at(glm::dvec3 point) const;

    size_t triangles() const { return triangles_.size(); }

  private:
    struct Triangle {
        std::array<glm::dvec3, 3> corner;
        glm::dvec3 face;                   // unit
        std::array<glm::dvec3, 3> edge;    // pseudo-normal of corner k to k + 1
        std::array<glm::dvec3, 3> vertex;  // pseudo-normal of corner k, weighted by angles
    };
    struct Box {
        glm::dvec3 low, high;
        uint32_t first = 0, count = 0;  // leaves: triangles; else count 0 and `first` is the second child
    };
    uint32_t build(uint32_t first, uint32_t count);
    double square(const Box& box, glm::dvec3 point) const;

    std::vector<Triangle> triangles_;
    std::vector<Box> boxes_;
};

}  // namespace espalier::fidelitytest
