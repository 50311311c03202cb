#pragma once

// What meshes of roofs and walls are put together from. Texture coordinates: u is how bright the mesh leaves its
// shape's colour (1: as it is; recesses are darker); v is 0 but for bars, see thinAcross.

#include <cmath>
#include <functional>
#include <string>

#include "tools/content/roof_mesh.hpp"

namespace espalier::content {

// Vertices from `first` on are a bar's: their v tells which side of its middle they lie on, by its sign, and half its
// width in the shape's; of bars that are thin along x, 1 more.
inline void thinAcross(Mesh& mesh, size_t first, glm::vec3 low, glm::vec3 high) {
    const int axis = high.x - low.x < high.y - low.y ? 0 : 1;
    const float middle = (low[axis] + high[axis]) / 2, half = (high[axis] - low[axis]) / 2;
    for (size_t i = first; i < mesh.positions.size(); ++i)
        mesh.uvs[i].y = (axis == 0 ? 1 + half : half) * (mesh.positions[i][axis] < middle ? -1.0f : 1.0f);
}

class Solid {
  public:
    Mesh mesh;

    // Counterclockwise seen from outside; flat.
    Solid& quad(glm::vec3 a, glm::vec3 b, glm::vec3 c, glm::vec3 d, float shade = 1) {
        const glm::vec3 n = glm::cross(c - a, d - b);
        const uint32_t first = uint32_t(mesh.positions.size());
        for (glm::vec3 p : {a, b, c, d}) add(p, n, shade);
        for (uint32_t i : {0u, 1u, 2u, 0u, 2u, 3u}) mesh.indices.push_back(first + i);
        return *this;
    }
    Solid& triangle(glm::vec3 a, glm::vec3 b, glm::vec3 c, float shade = 1) {
        const glm::vec3 n = glm::cross(b - a, c - a);
        const uint32_t first = uint32_t(mesh.positions.size());
        for (glm::vec3 p : {a, b, c}) add(p, n, shade);
        for (uint32_t i : {0u, 1u, 2u}) mesh.indices.push_back(first + i);
        return *this;
    }
    // Without the side at the lowest z, which lies on something.
    Solid& box(glm::vec3 low, glm::vec3 high, float shade = 1) {
        auto at = [&](int x, int y, int z) {
            return glm::vec3(x ? high.x : low.x, y ? high.y : low.y, z ? high.z : low.z);
        };
        quad(at(0, 0, 1), at(1, 0, 1), at(1, 1, 1), at(0, 1, 1), shade);
        quad(at(0, 0, 0), at(1, 0, 0), at(1, 0, 1), at(0, 0, 1), shade);
        quad(at(1, 0, 0), at(1, 1, 0), at(1, 1, 1), at(1, 0, 1), shade);
        quad(at(1, 1, 0), at(0, 1, 0), at(0, 1, 1), at(1, 1, 1), shade);
        return quad(at(0, 1, 0), at(0, 0, 0), at(0, 0, 1), at(0, 1, 1), shade);
    }
    // A box that is a bar before a pane: where it is thinner than a pixel it is drawn one pixel wide, and the fainter.
    Solid& bar(glm::vec3 low, glm::vec3 high) {
        const size_t first = mesh.positions.size();
        box(low, high);
        thinAcross(mesh, first, low, high);
        return *this;
    }
    // A sheet over (s, t) in [0, 1]^2 whose normals are smooth; shade too is a function of both.
    using Point = std::function<glm::vec3(float s, float t)>;
    using Shade = std::function<float(float s, float t)>;
    Solid& sheet(int across, int up, const Point& point, const Shade& shade = nullptr) {
        const uint32_t first = uint32_t(mesh.positions.size());
        constexpr float kStep = 1e-3f;
        for (int j = 0; j <= up; ++j)
            for (int i = 0; i <= across; ++i) {
                const float s = float(i) / float(across), t = float(j) / float(up);
                const glm::vec3 ds = point(s + kStep, t) - point(s - kStep, t),
                                dt = point(s, t + kStep) - point(s, t - kStep);
                add(point(s, t), glm::cross(ds, dt), shade ? shade(s, t) : 1.0f);
            }
        const uint32_t row = uint32_t(across) + 1;
        for (uint32_t j = 0; j < uint32_t(up); ++j)
            for (uint32_t i = 0; i < uint32_t(across); ++i) {
                const uint32_t a = first + j * row + i;
                for (uint32_t v : {a, a + 1, a + row + 1, a, a + row + 1, a + row}) mesh.indices.push_back(v);
            }
        return *this;
    }

  private:
    void add(glm::vec3 p, glm::vec3 n, float shade) {
        const float l = glm::length(n);
        mesh.positions.push_back(p);
        mesh.normals.push_back(l > 1e-12f ? n / l : glm::vec3(0, 0, 1));
        mesh.uvs.emplace_back(shade, 0);
        mesh.weld.push_back(uint32_t(mesh.weld.size()));
    }
};

// Tiles and what covers their joints; gutters, chimneys, dormers; windows and doors.
void addCoverings(RoofMeshes& out);
void addFittings(RoofMeshes& out);
void addOpenings(RoofMeshes& out);

}  // namespace espalier::content
