// In: where a card lies and what of the atlas it shows. Out: its two triangles.
#include "tools/content/card.hpp"

#include <algorithm>
#include <cmath>

#include "shaders/render/prop_records.h"

namespace espalier::content {
namespace {

// A direction, either way: its square of the octahedron, which foliage.vert reads.
float facingCode(glm::vec3 n) {
    n /= std::abs(n.x) + std::abs(n.y) + std::abs(n.z);
    glm::vec2 o(n.x, n.z);
    if (n.y < 0) o = (1.0f - glm::vec2(std::abs(n.z), std::abs(n.x))) * glm::vec2(n.x < 0 ? -1 : 1, n.z < 0 ? -1 : 1);
    constexpr int kSide = int(kFacingSide);
    const glm::ivec2 at = glm::clamp(glm::ivec2((o * 0.5f + 0.5f) * float(kSide)), 0, kSide - 1);
    return float(at.x + kSide * at.y);
}

}  // namespace

void addCard(Mesh& mesh, glm::vec3 at, glm::vec3 out, glm::vec3 up, float side, Cell cell, const LitAt& litAt) {
    const glm::vec3 x = glm::normalize(glm::cross(up, out)), y = glm::cross(out, x);
    const uint32_t first = uint32_t(mesh.positions.size());
    const float facing = facingCode(glm::cross(x, y));
    for (int k = 0; k < 4; ++k) {
        const glm::vec2 c(k == 1 || k == 2 ? 1 : 0, k >= 2 ? 1 : 0);
        const glm::vec3 p = at + side * ((c.x - 0.5f) * x + (c.y - 0.5f) * y);
        mesh.positions.push_back(p);
        const Lit lit = litAt(p);
        mesh.normals.push_back(lit.normal);
        mesh.uvs.push_back(glm::vec2(std::round(lit.open * 8), -1 - facing) + cell.low +
                           cell.side * (0.02f + 0.96f * glm::vec2(c.x, 1 - c.y)));
    }
    for (uint32_t k : {0u, 1u, 2u, 0u, 2u, 3u}) mesh.indices.push_back(first + k);
}

Cell cellOf(int lod, int row, float chance) {
    const int column = lod > 0 ? kFarColumn : std::min(int(float(kFarColumn) * chance), kFarColumn - 1);
    return {{kFirstCell + kCellSide * float(column), kCellSide * float(row)}};
}

}  // namespace espalier::content
