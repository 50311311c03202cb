#pragma once

#include <algorithm>
#include <array>

#include "runtime/surface/surface.hpp"

namespace espalier {

// Weights of the corners uv0, uv1, uv2 of a triangle; beyond it they are cut to what lies so far outside, in sizes of
// the triangle.
inline std::array<double, 3> weightsAt(const TrianglePlane& plane, glm::dvec2 uv, double beyond) {
    const glm::dvec2 a(plane.uv0), b = glm::dvec2(plane.uv1) - a, c = glm::dvec2(plane.uv2) - a, p = uv - a;
    const double area = b.x * c.y - b.y * c.x;
    if (area == 0) return {1, 0, 0};
    const double v = std::clamp((p.x * c.y - p.y * c.x) / area, -beyond, 1 + beyond);
    const double w = std::clamp((b.x * p.y - b.y * p.x) / area, -beyond, 1 + beyond);
    return {1 - v - w, v, w};
}

}  // namespace espalier
