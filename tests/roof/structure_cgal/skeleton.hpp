#pragma once

// CGAL's straight skeleton (GPL: an oracle of tests and benchmarks, linked by nothing that ships).

#include <glm/glm.hpp>
#include <vector>

namespace espalier::test {

struct CgalSkeleton {
    struct Face {
        glm::dvec2 a, b;  // its edge
        std::vector<glm::dvec2> outline;
    };
    std::vector<Face> faces;
    // Distance of the roof's edge from p, straight in: the height at slope 1. NaN outside.
    double heightAt(glm::dvec2 p) const;
};

// Rings as in RoofHouse. No faces: CGAL failed.
CgalSkeleton cgalSkeleton(const std::vector<std::vector<glm::dvec2>>& rings);
// Makes the skeleton and throws it away; returns its number of faces. For benchmarks.
size_t cgalFaces(const std::vector<std::vector<glm::dvec2>>& rings);

}  // namespace espalier::test
