// The atlas of trees and bushes. In: nothing. Out: twigs with leaves as seen from outside a crown, alpha a ramp over
// the distance to the leaves' edge, so that mip levels keep their area; and two barks.

#include <algorithm>
#include <cmath>

#include "runtime/core/srgb.hpp"
#include "tools/content/foliage.hpp"
#include "tools/content/maths.hpp"
#include "tools/content/noise.hpp"

namespace espalier::content {
namespace {

// Rows of the atlas: lime, apple, birch, shrub.
const Species kSpecies[] = {{0.080f, 0.058f, 18, 1.25f, {0.019f, 0.038f, 0.011f}, {0.116f, 0.160f, 0.042f}, 0.05f},
                            {0.074f, 0.042f, 19, 1.20f, {0.022f, 0.037f, 0.016f}, {0.120f, 0.150f, 0.062f}, 0.03f},
                            {0.056f, 0.044f, 19, 1.10f, {0.026f, 0.046f, 0.013f}, {0.132f, 0.176f, 0.050f}, 0.06f},
                            {0.066f, 0.042f, 20, 1.15f, {0.021f, 0.037f, 0.014f}, {0.112f, 0.146f, 0.048f}, 0.02f}};

// A line of leaves.
struct Sprig {
    glm::vec2 root;
    float heading, bend, reach;  // radians from up, clockwise; cells
    float scale, bright, lie;    // of its leaves
};

// Leaves stand on it in turn, its last one on its tip. What is farther out lies over the rest and is lighter, the more
// so the more it leads up.
void addSprig(std::vector<Leaf>& leaves, const Species& s, const Sprig& sprig, uint32_t salt) {
    const int count = std::max(3, int(2.5f * sprig.reach / (sprig.scale * s.length) + 0.5f));
    for (int i = 0; i < count; ++i) {
        const auto random = [&](uint32_t which) { return random01(salt, uint32_t(i), which); };
        const bool last = i + 1 == count;
        const float u = (float(i) + 0.6f * random(0) + 0.4f) / float(count), angle = sprig.heading + sprig.bend * u;
        const glm::vec2 at = sprig.root + sprig.reach * u * glm::vec2(std::sin(angle), -std::cos(angle));
        const float turn = angle + (last ? 0 : (i % 2 ? 0.9f : -0.9f) + 0.9f * (random(1) - 0.5f));
        const float size = sprig.scale * (0.8f + 0.45f * random(2) - 0.15f * u);
        const glm::vec2 along(std::sin(turn), -std::cos(turn)), tip = at + s.length * size * along;
        if (glm::any(glm::greaterThan(glm::abs(tip - 0.5f), glm::vec2(0.48f)))) continue;
        const float bright = sprig.bright + 0.42f * random(4) + 0.45f * u * u + 0.25f * u * std::cos(angle);
        leaves.push_back({at, along, s.length * size, s.width * size * (0.6f + 0.4f * random(3)),
                          glm::clamp(bright, 0.0f, 1.0f), sprig.lie + 0.7f * sprig.reach * u + 0.08f * random(5)});
    }
}

// A twig rises through the cell, sprigs leave it to both sides, the longest in its middle.
std::vector<Leaf> twigLeaves(const Species& s, uint32_t salt) {
    std::vector<Leaf> leaves;
    const int sprigs = 7 * s.sprigs / 4;
    const float sway = 0.16f * (random01(salt, 7) - 0.5f);
    for (int k = 0; k < sprigs; ++k) {
        const auto random = [&](uint32_t which) { return random01(salt + 97, uint32_t(k), which); };
        const bool top = k + 1 == sprigs;
        const float t = float(k) / float(sprigs - 1), side = k % 2 ? 1.0f : -1.0f;
        const glm::vec2 root(0.5f + sway * std::sin(kPi * t), 0.84f - 0.50f * t);
        const float heading = top ? 0 : side * s.spread * (1.25f - 0.65f * t) + 0.9f * (random(0) - 0.5f);
        const float longest = 0.22f + 0.22f * std::sin(kPi * (0.20f + 0.55f * t));
        addSprig(leaves, s,
                 {root, heading, -side * 0.5f * random(1), longest * (0.55f + 0.60f * random(2)), 0.75f,
                  0.95f * (random(3) - 0.4f) + 0.05f, 0.25f * random(3)},
                 salt + uint32_t(k) * 7919);
    }
    return leaves;
}

// Far off many twigs are one: clumps of short sprigs, each light above and dark below, the lower before the upper, with
// gaps at the cell's border.
std::vector<Leaf> farLeaves(const Species& s, uint32_t salt) {
    constexpr int kClumps = 12, kSprigs = 17;
    std::vector<Leaf> leaves;
    for (int c = 0; c < kClumps; ++c) {
        const float about = 2.399963f * float(c), wide = 0.34f * std::sqrt((float(c) + 0.3f) / float(kClumps));
        const glm::vec2 middle = 0.5f + wide * glm::vec2(std::cos(about), std::sin(about));
        for (int k = 0; k < kSprigs; ++k) {
            const uint32_t own = salt + uint32_t(c * kSprigs + k) * 7919;
            const auto random = [&](uint32_t which) { return random01(own, which); };
            const float heading = 2.399963f * float(k) + 0.8f * (random(0) - 0.5f);
            const glm::vec2 out(std::sin(heading), -std::cos(heading));
            addSprig(leaves, s,
                     {middle + 0.04f * out, heading, 0.5f * (random(1) - 0.5f), 0.07f + 0.09f * random(2), 0.55f,
                      0.40f * (random(3) - 0.5f) - 0.35f * out.y, 2 * middle.y},
                     own + 1);
        }
    }
    return leaves;
}

void paintTwig(Picture& picture, int x0, int y0, int side, const Species& s, uint32_t salt, bool far) {
    std::vector<glm::vec3> colors(size_t(side) * size_t(side), 0.35f * (s.dark + s.light));
    std::vector<float> edges(colors.size(), -1.0f);
    std::vector<Leaf> leaves = far ? farLeaves(s, salt) : twigLeaves(s, salt);
    std::stable_sort(leaves.begin(), leaves.end(), [](const Leaf& a, const Leaf& b) { return a.lie < b.lie; });
    for (const Leaf& leaf : leaves) {
        const float reach = 1.4f * leaf.length;
        const auto texelOf = [&](float p) { return std::clamp(int(p * float(side)), 0, side - 1); };
        for (int y = texelOf(leaf.foot.y - reach); y <= texelOf(leaf.foot.y + reach); ++y)
            for (int x = texelOf(leaf.foot.x - reach); x <= texelOf(leaf.foot.x + reach); ++x) {
                float across = 0;
                const float edge = leafEdge(leaf, s, (glm::vec2(x, y) + 0.5f) / float(side), across);
                const size_t at = size_t(y) * size_t(side) + size_t(x);
                edges[at] = std::max(edges[at], edge);
                if (edge >= 0) colors[at] = leafColor(leaf, s, edge, across);
            }
    }
    for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x) {
            const size_t at = size_t(y) * size_t(side) + size_t(x);
            putTexel(picture.at(x0 + x, y0 + y), colors[at], edges[at], side);
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
            for (int k = 0; k < 3; ++k) texel[k] = toByte(srgbOfLinear(color[k]));
            texel[3] = x < first ? 255 : 0;
        }
    for (int row = 0; row < 4; ++row)
        for (int column = 0; column < 3; ++column)
            paintTwig(picture, first + column * side, row * side, side, kSpecies[row],
                      450u + uint32_t(row) * 8 + uint32_t(column), column == kFarColumn);
    const int flowers = int(float(size) * kFlowerSide);
    for (int kind = 0; kind < kFlowers; ++kind)
        paintFlowers(picture, size - flowers, kind * flowers, flowers, kind, 490u + uint32_t(kind));
    for (int kind = 0; kind < kMeadows; ++kind)
        paintMeadow(picture, size - flowers, (kFlowers + kind) * flowers, flowers, kind == 1, 500u + uint32_t(kind));
    paintClover(picture, size - flowers, kCloverCell * flowers, flowers, 510);
    return picture;
}

}  // namespace espalier::content
