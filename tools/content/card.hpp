#pragma once

// Foliage on cards, as trees and smaller plants have it.

#include "tools/content/props.hpp"

namespace espalier::content {

constexpr int kPlantLods = 3;

// What a card's place tells of its normal: it leads out of the crown and of the lobe.
struct Round {
    glm::vec3 middle, squash, lobe;
    glm::vec3 normal(glm::vec3 p) const {
        return glm::normalize((p - middle) / squash) + 0.8f * glm::normalize(p - lobe);
    }
};

// Of the atlas.
struct Cell {
    glm::vec2 low;
    float side = kCellSide;
};

// Two triangles about `at`, facing `out`; its twig points along `up`. Normals lead out of what is round; the whole part
// of u is how open the card lies, in eighths.
void addCard(Mesh& mesh, glm::vec3 at, glm::vec3 out, glm::vec3 up, float side, Cell cell, float open,
             const Round& round);

// chance: 0 to 1, picks among the twigs of a species.
Cell cellOf(int lod, int row, float chance);

}  // namespace espalier::content
