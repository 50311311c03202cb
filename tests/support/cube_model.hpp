#pragma once

// Models made in tests: a cube with a chart a face, and what it is formed into.

#include <glm/glm.hpp>
#include <string>

#include "tools/bake/bake.hpp"

namespace espalier::test {

// A cube of edge 2 m around the origin, n × n quads a face, each face's chart a cell of a 3 × 2 atlas. form(point)
// says where its points go; normals stay the cube's.
template <typename Form>
Model formedCube(std::string name, uint32_t n, Form form) {
    Model model;
    model.name = std::move(name);
    for (uint32_t face = 0; face < 6; ++face) {
        glm::vec3 normal(0), u(0);
        normal[int(face / 2)] = face % 2 ? -1.0f : 1.0f;
        u[int((face / 2 + 1) % 3)] = 1;
        const glm::vec3 v = glm::cross(normal, u);
        const glm::vec2 cell(float(face % 3) / 3, float(face / 3) / 2);
        const uint32_t first = uint32_t(model.positions.size());
        for (uint32_t i = 0; i < (n + 1) * (n + 1); ++i) {
            const float a = float(i % (n + 1)) / float(n), b = float(i / (n + 1)) / float(n);
            model.positions.push_back(form(normal + u * (2 * a - 1) + v * (2 * b - 1)));
            model.normals.push_back(normal);
            model.uvs.push_back(cell + glm::vec2(0.03f + 0.27f * a, 0.05f + 0.4f * b));
        }
        for (uint32_t i = 0; i < n * n; ++i) {
            const uint32_t a = first + i / n * (n + 1) + i % n, c = a + n + 1;
            for (uint32_t k : {a, a + 1, c + 1, a, c + 1, c}) model.indices.push_back(k);
        }
    }
    return model;
}

inline Model cube() {
    return formedCube("cube", 1, [](glm::vec3 p) { return p; });
}

// The cube pushed onto a ball of radius 1 m.
inline Model ball(uint32_t n = 24) {
    Model model = formedCube("ball", n, [](glm::vec3 p) { return glm::normalize(p); });
    model.normals = model.positions;
    return model;
}

}  // namespace espalier::test
