#pragma once

// Foliage on cards, as trees and smaller plants have it.

#include <functional>

#include "tools/content/props.hpp"

namespace espalier::content {

constexpr int kPlantLods = 3;

// How a place of what is round is lit.
struct Lit {
    glm::vec3 normal;
    float open;  // share of the sky that is seen from it
};
using LitAt = std::function<Lit(glm::vec3)>;

// Of the atlas.
struct Cell {
    glm::vec2 low;
    float side = kCellSide;
};

// Two triangles about `at`, facing `out`; its twig points along `up`. The whole part of a corner's u is how open it
// lies, in eighths; that of v, below 0, is where the card faces.
void addCard(Mesh& mesh, glm::vec3 at, glm::vec3 out, glm::vec3 up, float side, Cell cell, const LitAt& litAt);

// chance: 0 to 1, picks among the twigs of a species.
Cell cellOf(int lod, int row, float chance);

}  // namespace espalier::content
