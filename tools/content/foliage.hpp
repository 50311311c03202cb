#pragma once

// What the pictures of foliage are painted of: leaves over each other, cut out along a distance ramp. Places are in
// cells, y down.

#include <vector>

#include "tools/content/props.hpp"

namespace espalier::content {

struct Species {
    float length, width;    // of a leaf, in cells
    int sprigs;             // on a twig
    float spread;           // radians that its sprigs stand off
    glm::vec3 dark, light;  // linear
    float serrated;         // of its edge
};
struct Leaf {
    glm::vec2 foot, along;
    float length, width, bright, lie;  // what lies higher hides the rest
    bool stem = false;                 // as wide at its ends as between them
};

// Distance to a leaf's edge, positive inside, in cells; across: where in the leaf, -1 to 1.
float leafEdge(const Leaf& leaf, const Species& s, glm::vec2 p, float& across);
glm::vec3 leafColor(const Leaf& leaf, const Species& s, float edge, float across);
// edge: how far inside what is painted, in cells; beside it, negative.
void putTexel(uint8_t* texel, glm::vec3 color, float edge, int side);
// Lays leaves over what has this edge and colour at p, each over those before it. True: one of them covers it.
bool overLeaves(const std::vector<Leaf>& leaves, const Species& s, glm::vec2 p, float& edge, glm::vec3& color);

// The atlas' small plants; side: of a cell, texels; kind: of flowers, below kFlowers; blooms: with flowers in the
// grass.
void paintFlowers(Picture& picture, int x0, int y0, int side, int kind, uint32_t salt);
void paintMeadow(Picture& picture, int x0, int y0, int side, bool blooms, uint32_t salt);
void paintClover(Picture& picture, int x0, int y0, int side, uint32_t salt);

}  // namespace espalier::content
