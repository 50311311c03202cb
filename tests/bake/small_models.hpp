#pragma once

// Small meshes whose charts and seams are known by construction.

#include <cmath>
#include <string>
#include <vector>

#include "tools/bake/bake.hpp"

namespace espalier::test {

// A grid over [0,1]², n × n quads: place(s, t) is the position, uv(s, t) the UV. Appends to the model.
template <class Place, class Uv>
void addPatch(Model& model, int n, Place&& place, Uv&& uv) {
    uint32_t base = uint32_t(model.positions.size());
    for (int j = 0; j <= n; ++j)
        for (int i = 0; i <= n; ++i) {
            float s = float(i) / float(n), t = float(j) / float(n);
            model.positions.push_back(place(s, t));
            model.uvs.push_back(uv(s, t));
        }
    uint32_t w = uint32_t(n) + 1;
    for (uint32_t j = 0; j < uint32_t(n); ++j)
        for (uint32_t i = 0; i < uint32_t(n); ++i) {
            uint32_t a = base + j * w + i, b = a + 1, c = a + w, d = c + 1;
            for (uint32_t v : {a, b, d, a, d, c}) model.indices.push_back(v);
        }
}

// Face `f` of the cube [-1,1]³, outward: right × up = normal.
inline glm::vec3 onCube(int f, float s, float t) {
    static const glm::vec3 normal[6] = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
    static const glm::vec3 right[6] = {{0, 0, -1}, {0, 0, 1}, {1, 0, 0}, {1, 0, 0}, {1, 0, 0}, {-1, 0, 0}};
    glm::vec3 up = glm::cross(normal[f], right[f]);
    return normal[f] + right[f] * (2 * s - 1) + up * (2 * t - 1);
}

// A chart a face, apart by a sixth of the square. `mirrored` faces lie mirrored in UV.
inline Model cube(int n, unsigned mirrored = 0) {
    Model model;
    model.name = "cube";
    for (int f = 0; f < 6; ++f)
        addPatch(
            model, n, [&](float s, float t) { return onCube(f, s, t); },
            [&](float s, float t) {
                glm::vec2 corner(0.05f + 0.33f * float(f % 3), 0.1f + 0.45f * float(f / 3));
                if (mirrored >> f & 1u) s = 1 - s;
                return corner + glm::vec2(s, t) * 0.25f;
            });
    return model;
}

// The cube's unfolding as a cross: one chart, creases inside, seams of the chart with itself.
inline Model cubeCross(int n) {
    struct Cell {
        glm::vec3 origin, right, up;
        int x, y;
    };
    // Four faces around the y axis in a row, lid and floor at the second.
    const Cell cells[6] = {{{-1, -1, 1}, {2, 0, 0}, {0, 2, 0}, 0, 1},  {{1, -1, 1}, {0, 0, -2}, {0, 2, 0}, 1, 1},
                           {{1, -1, -1}, {-2, 0, 0}, {0, 2, 0}, 2, 1}, {{-1, -1, -1}, {0, 0, 2}, {0, 2, 0}, 3, 1},
                           {{-1, 1, 1}, {2, 0, 0}, {0, 0, -2}, 0, 2},  {{-1, -1, -1}, {2, 0, 0}, {0, 0, 2}, 0, 0}};
    Model model;
    model.name = "cube in one chart";
    for (const Cell& c : cells)
        addPatch(
            model, n, [&](float s, float t) { return c.origin + c.right * s + c.up * t; },
            [&](float s, float t) { return glm::vec2(0.1f) + glm::vec2(float(c.x) + s, float(c.y) + t) * 0.2f; });
    return model;
}

// An open cylinder around y, cut once: its chart leads to itself.
inline Model cylinder(int n) {
    Model model;
    model.name = "cylinder";
    addPatch(
        model, n,
        [](float s, float t) {
            // The last column lies on the first one, bit for bit.
            float a = s >= 1 ? 0.0f : s * 6.2831853f;
            return glm::vec3(std::sin(a), t * 2 - 1, std::cos(a));
        },
        [](float s, float t) { return glm::vec2(0.05f + s * 0.9f, 0.2f + t * 0.3f); });
    return model;
}

inline Model openQuad(int n) {
    Model model;
    model.name = "quad";
    addPatch(
        model, n, [](float s, float t) { return glm::vec3(s, t, 0); },
        [](float s, float t) { return glm::vec2(0.2f) + glm::vec2(s, t) * 0.6f; });
    return model;
}

// Makes triangles bare that lie within a box.
inline void makeBare(Model& model, glm::vec3 low, glm::vec3 high) {
    model.materials.assign(2, Material{});
    model.materials[1].bare = true;
    model.triangleMaterial.clear();
    for (size_t i = 0; i < model.indices.size(); i += 3) {
        glm::vec3 middle(0);
        for (size_t k = 0; k < 3; ++k) middle += model.positions[model.indices[i + k]] / 3.0f;
        model.triangleMaterial.push_back(glm::all(glm::greaterThan(middle, low)) &&
                                         glm::all(glm::lessThan(middle, high)));
    }
}

}  // namespace espalier::test
