// In: a matrix. Out: the same as a move, a turn and a scale, which nodes that share meshes have.
#include "tools/export/placing.hpp"

#include <algorithm>

#include "tools/export/gltf_file.hpp"

namespace espalier::exporting {
namespace {

bool isIdentity(const EspTransform& t) {
    const EspTransform none = espIdentity();
    return std::equal(&t.rows[0][0], &t.rows[0][0] + 12, &none.rows[0][0]);
}

}  // namespace

Placing placingOf(const EspTransform& t) {
    Placing out;
    glm::mat3 axes;
    for (int column = 0; column < 3; ++column) {
        for (int row = 0; row < 3; ++row) axes[column][row] = t.rows[row][column];
        out.scale[column] = std::max(glm::length(axes[column]), 1e-12f);
        axes[column] /= out.scale[column];
    }
    if (glm::determinant(axes) < 0) axes[0] = -axes[0], out.scale.x = -out.scale.x;
    out.turn = glm::normalize(glm::quat_cast(axes));
    out.move = {t.rows[0][3], t.rows[1][3], t.rows[2][3]};
    return out;
}

std::string placeText(const EspTransform& transform) {
    if (isIdentity(transform)) return {};
    const Placing p = placingOf(transform);
    std::string text;
    appendNumbers(text, "translation", &p.move.x, 3, 5);
    const float turn[] = {p.turn.x, p.turn.y, p.turn.z, p.turn.w};
    appendNumbers(text, "rotation", turn, 4, 5);
    appendNumbers(text, "scale", &p.scale.x, 3, 7);
    return text;
}

}  // namespace espalier::exporting
