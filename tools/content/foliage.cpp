// The atlas of trees and bushes. In: nothing. Out: twigs with leaves as seen from outside a crown, alpha a ramp over
// the distance to the leaves' edge, so that mip levels keep their area; and two barks.

#include <algorithm>
#include <cmath>

#include "tools/content/noise.hpp"
#include "tools/content/props.hpp"

namespace espalier::content {
namespace {

constexpr float kPi = 3.14159265f;

struct Species {
    float length, width;    // of a leaf, in cells
    int sprigs, leaves;     // on a twig; on a sprig
    glm::vec3 dark, light;  // linear
    float serrated;         // of its edge
};
// Rows of the atlas: lime, apple, birch, shrub.
const Species kSpecies[] = {{0.078f, 0.056f, 29, 8, {0.026f, 0.050f, 0.016f}, {0.094f, 0.136f, 0.040f}, 0.05f},
                            {0.072f, 0.042f, 33, 8, {0.030f, 0.050f, 0.024f}, {0.100f, 0.128f, 0.058f}, 0.03f},
                            {0.056f, 0.044f, 33, 8, {0.042f, 0.066f, 0.018f}, {0.130f, 0.156f, 0.046f}, 0.06f},
                            {0.064f, 0.042f, 36, 8, {0.028f, 0.050f, 0.020f}, {0.092f, 0.122f, 0.044f}, 0.02f}};

struct Leaf {
    glm::vec2 foot, along;
    float length, width, bright, lie;
};

// Sprigs spread from about the cell's middle and leave gaps between their tips; leaves stand on them in turn to both
// sides. What is farther out lies over the rest and is lighter. scale: of leaves and sprigs.
std::vector<Leaf> twigLeaves(const Species& s, uint32_t salt, float scale) {
    std::vector<Leaf> leaves;
    const int sprigs = int(float(s.sprigs) / (scale * scale));
    for (int k = 0; k < sprigs; ++k) {
        const auto ofSprig = [&](uint32_t which) { return random01(salt + 97, uint32_t(k), which); };
        const float angle = 2.399963f * float(k) + 0.9f * (ofSprig(0) - 0.5f), bend = 1.6f * (ofSprig(1) - 0.5f);
        const float reach = scale * (0.10f + 0.14f * ofSprig(2)),
                    from = (0.44f - 0.24f * scale) * std::sqrt(ofSprig(3));
        const glm::vec2 root = glm::vec2(0.5f) + from * glm::vec2(std::cos(angle), std::sin(angle));
        for (int i = 0; i < s.leaves; ++i) {
            const auto random = [&](uint32_t which) { return random01(salt, uint32_t(k * s.leaves + i), which); };
            const bool tip = i + 1 == s.leaves;
            const float t = std::sqrt((float(i) + 0.3f + 0.7f * random(0)) / float(s.leaves)),
                        heading = angle + bend * t;
            const glm::vec2 at = root + reach * t * glm::vec2(std::cos(heading), std::sin(heading));
            const float turn = heading + bend * t + (tip ? 0 : (i % 2 ? 0.95f : -0.95f) + 0.7f * (random(1) - 0.5f));
            const float size = scale * (0.8f + 0.4f * random(2) - 0.2f * t);
            leaves.push_back({at,
                              {std::cos(turn), std::sin(turn)},
                              s.length * size,
                              s.width * size * (0.6f + 0.4f * random(3)),
                              glm::clamp(0.75f * random(4) + 2.2f * (from + reach * t) - 0.45f, 0.0f, 1.0f),
                              from + reach * t + 0.15f * random(5)});
        }
    }
    std::stable_sort(leaves.begin(), leaves.end(), [](const Leaf& a, const Leaf& b) { return a.lie < b.lie; });
    return leaves;
}

// Distance to a leaf's edge, positive inside, in cells; along and across: where in the leaf, -1 to 1 across.
float leafEdge(const Leaf& leaf, const Species& s, glm::vec2 p, float& along, float& across) {
    const glm::vec2 d = p - leaf.foot;
    along = glm::dot(d, leaf.along) / leaf.length;
    const float side = leaf.along.x * d.y - leaf.along.y * d.x;
    if (along < -0.3f || along > 1.3f) return -1;
    const float t = glm::clamp(along, 0.0f, 1.0f);
    float half = 0.5f * leaf.width * std::pow(std::max(std::sin(kPi * std::pow(t, 0.75f)), 0.0f), 0.8f);
    half *= 1 + s.serrated * std::sin(60 * t);
    across = half > 1e-5f ? side / half : 0;
    const float beyond = std::max(-along, along - 1) * leaf.length;
    return std::min(half - std::abs(side), -beyond);
}

void paintTwig(Picture& picture, int x0, int y0, int side, const Species& s, uint32_t salt, float scale) {
    const std::vector<Leaf> leaves = twigLeaves(s, salt, scale);
    const glm::vec3 mean = 0.5f * (s.dark + s.light);
    for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x) {
            const glm::vec2 p = (glm::vec2(x, y) + 0.5f) / float(side);
            glm::vec3 color = mean * 0.7f;
            float edge = -1;
            for (const Leaf& leaf : leaves) {
                if (glm::distance(p, leaf.foot) > 1.4f * leaf.length) continue;
                float along = 0, across = 0;
                const float e = leafEdge(leaf, s, p, along, across);
                edge = std::max(edge, e);
                if (e < 0) continue;
                color = glm::mix(s.dark, s.light, leaf.bright);
                color *= 0.86f + 0.20f * across * (leaf.bright > 0.5f ? 1.0f : -1.0f);  // one half towards the light
                color = glm::mix(color, s.light * 1.25f, 0.35f * ramp(0.16f, 0.03f, std::abs(across)));
                color *= 0.72f + 0.28f * ramp(0.0f, 0.010f, e);  // the next leaf's shadow
            }
            uint8_t* texel = picture.at(x0 + x, y0 + y);
            for (int k = 0; k < 3; ++k) texel[k] = uint8_t(saturate(toSrgb(color[k])) * 255 + 0.5f);
            texel[3] = uint8_t(saturate(0.5f + edge * float(side) / 10) * 255 + 0.5f);
        }
}

glm::vec3 barkColor(glm::vec2 p, bool birch) {
    const glm::ivec2 cells = birch ? glm::ivec2(4, 8) : glm::ivec2(12, 5);  // furrows lie along a trunk
    const float furrow = tilingFractal(p * glm::vec2(cells), cells, birch ? 411 : 421, 4);
    const float fine = tilingFractal(p * glm::vec2(24, 20), {24, 20}, 431, 3);
    if (birch) {
        const float scar = ramp(0.22f, 0.42f, tilingFractal(p * glm::vec2(2, 24), {2, 24}, 441, 3));
        return glm::mix(glm::vec3(0.56f, 0.54f, 0.48f) * (1 + 0.2f * furrow), glm::vec3(0.07f, 0.06f, 0.05f),
                        0.85f * scar);
    }
    const glm::vec3 ridge =
        glm::mix(glm::vec3(0.045f, 0.034f, 0.024f), glm::vec3(0.165f, 0.135f, 0.100f), saturate(0.5f + 0.8f * furrow));
    return ridge * (1 + 0.4f * fine);
}

}  // namespace

Picture paintFoliage(int size) {
    Picture picture(size, size);
    const int side = int(float(size) * kCellSide), first = int(float(size) * kFirstCell);
    for (int y = 0; y < size; ++y)
        for (int x = 0; x < size; ++x) {
            uint8_t* texel = picture.at(x, y);
            const glm::vec2 p(float(x) / float(first) * 2, float(y) / float(size));
            const glm::vec3 color =
                x < first ? barkColor(glm::fract(p), x >= first / 2) : glm::vec3(0.05f, 0.09f, 0.02f);
            for (int k = 0; k < 3; ++k) texel[k] = uint8_t(saturate(toSrgb(color[k])) * 255 + 0.5f);
            texel[3] = x < first ? 255 : 0;
        }
    for (int row = 0; row < 4; ++row)
        for (int column = 0; column < 3; ++column)
            paintTwig(picture, first + column * side, row * side, side, kSpecies[row],
                      450u + uint32_t(row) * 8 + uint32_t(column), column < kFarColumn ? 0.75f : 0.5f);
    return picture;
}

}  // namespace espalier::content
