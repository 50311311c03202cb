#pragma once

// Where two triangles touch: the geometry of contacts, without any mesh.

#include <array>
#include <glm/glm.hpp>

namespace espalier {

struct ContactShape {
    std::array<glm::dvec3, 3> p;
    std::array<double, 3> reach;  // per corner: nearer to the other's plane it lies in it
    std::array<bool, 3> outline;  // per edge: the surface bends or ends there
    glm::dvec3 normal;            // unit
};

// A stretch of contact, as it lies on each side. edge: along that edge of the side's triangle, -1: across the triangle.
struct ContactSegment {
    struct Side {
        glm::dvec3 a, b;
        int edge;
    } side[2];
    bool gone = false;  // no contact: along so much of these edges the surface goes on and touches elsewhere
};

// Up to six stretches; returns their number. Triangles that cross have one. In one plane: the outlines of each as far
// as they lie in the other.
int touch(const ContactShape& s, const ContactShape& t, std::array<ContactSegment, 6>& out);

}  // namespace espalier
