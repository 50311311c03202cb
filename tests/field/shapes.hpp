#pragma once

// Meshes whose geometry formulas know.

#include <algorithm>
#include <cmath>
#include <functional>
#include <glm/glm.hpp>
#include <numbers>
#include <vector>

namespace espalier {

inline double medianOf(std::vector<double> all) {
    std::nth_element(all.begin(), all.begin() + std::ptrdiff_t(all.size() / 2), all.end());
    return all[all.size() / 2];
}

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
        const double a = 2 * std::numbers::pi * (nu * u == nu ? 0 : u),
                     b = 2 * std::numbers::pi * (nv * v == nv ? 0 : v);
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

// A flat box with a row of square holes through it: of as many handles. Each side of a cube has n² cells.
inline std::vector<glm::dvec3> plateCorners(int holes, uint32_t n = 8) {
    const auto solid = [&](int x, int y, int z) {
        return x >= 0 && x <= 2 * holes && z >= 0 && z < 3 && y == 0 && !(z == 1 && x % 2 == 1);
    };
    std::vector<glm::dvec3> all;
    for (int x = 0; x <= 2 * holes; ++x)
        for (int z = 0; z < 3; ++z)
            for (int side = 0; side < 6 && solid(x, 0, z); ++side) {
                const int axis = side / 2, sign = side % 2 == 0 ? 1 : -1;
                const glm::ivec3 beyond = glm::ivec3(x, 0, z) + sign * glm::ivec3(axis == 0, axis == 1, axis == 2);
                if (solid(beyond.x, beyond.y, beyond.z)) continue;
                const auto corners = gridCorners(n, n, [=](double u, double v) {
                    glm::dvec3 p;
                    p[axis] = sign > 0 ? 1 : 0;
                    p[(axis + 1) % 3] = sign > 0 ? u : v;
                    p[(axis + 2) % 3] = sign > 0 ? v : u;
                    return glm::dvec3(x, 0, z) + p;
                });
                all.insert(all.end(), corners.begin(), corners.end());
            }
    return all;
}

}  // namespace espalier
