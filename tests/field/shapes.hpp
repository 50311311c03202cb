#pragma once

// Meshes whose geometry formulas know.

#include <cmath>
#include <functional>
#include <glm/glm.hpp>
#include <numbers>
#include <vector>

namespace espalier {

// Two triangles for each cell of a grid over (u, v) in [0, 1]²; counterclockwise as seen from where u × v points to.
inline std::vector<glm::dvec3> gridCorners(uint32_t nu, uint32_t nv,
                                           const std::function<glm::dvec3(double, double)>& place) {
    std::vector<glm::dvec3> corners;
    const auto at = [&](uint32_t i, uint32_t j) { return place(double(i) / nu, double(j) / nv); };
    for (uint32_t i = 0; i < nu; ++i)
        for (uint32_t j = 0; j < nv; ++j) {
            const glm::dvec3 a = at(i, j), b = at(i + 1, j), c = at(i + 1, j + 1), d = at(i, j + 1);
            if ((i + j) % 2 == 0)
                corners.insert(corners.end(), {a, b, c, a, c, d});
            else
                corners.insert(corners.end(), {a, b, d, b, c, d});
        }
    return corners;
}

inline std::vector<glm::dvec3> torusCorners(double large, double small, uint32_t nu = 96, uint32_t nv = 48) {
    return gridCorners(nu, nv, [=](double u, double v) {
        const double a = 2 * std::numbers::pi * (nu * u == nu ? 0 : u), b = 2 * std::numbers::pi * (nv * v == nv ? 0 : v);
        const double r = large + small * std::cos(b);
        return glm::dvec3(r * std::cos(a), small * std::sin(b), -r * std::sin(a));
    });
}

// A cube's sides, each a grid, blown up to a sphere.
inline std::vector<glm::dvec3> sphereCorners(double radius, uint32_t n = 24) {
    std::vector<glm::dvec3> all;
    for (int side = 0; side < 6; ++side) {
        const auto corners = gridCorners(n, n, [=](double u, double v) {
            const double s = std::tan((u - .5) * std::numbers::pi / 2), t = std::tan((v - .5) * std::numbers::pi / 2);
            glm::dvec3 p(s, t, 1);
            for (int turn = 0; turn < (side < 4 ? side : 0); ++turn) p = {p.z, p.y, -p.x};
            if (side == 4) p = {p.x, p.z, -p.y};
            if (side == 5) p = {p.x, -p.z, p.y};
            return radius * glm::normalize(p);
        });
        all.insert(all.end(), corners.begin(), corners.end());
    }
    return all;
}

inline std::vector<glm::dvec3> planeCorners(double side, uint32_t n = 40) {
    return gridCorners(n, n, [=](double u, double v) { return glm::dvec3(side * (u - .5), 0, side * (.5 - v)); });
}

}  // namespace espalier
