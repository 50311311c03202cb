// Small plants of the atlas of foliage. In: nothing. Out: leaves as painted ones lie, flowers, tall grass, clover.

#include <algorithm>
#include <cmath>

#include "runtime/core/srgb.hpp"
#include "tools/content/foliage.hpp"
#include "tools/content/maths.hpp"
#include "tools/content/noise.hpp"

namespace espalier::content {
namespace {

constexpr float kStem = 0.023f;  // wide: three texels, or smaller pictures lose it below its blossom

struct Blossom {
    glm::vec3 petals, middle;  // linear
    float radius;              // in cells
    int count;
    float tilt;  // how much flatter the most tilted ones are seen
};
// Daisies, geraniums, cornflowers.
const Blossom kBlossoms[kFlowers] = {{{0.72f, 0.70f, 0.62f}, {0.62f, 0.40f, 0.03f}, 0.058f, 11, 1.3f},
                                     {{0.56f, 0.045f, 0.035f}, {0.30f, 0.02f, 0.02f}, 0.085f, 10, 0.2f},
                                     {{0.20f, 0.19f, 0.52f}, {0.12f, 0.07f, 0.30f}, 0.060f, 15, 0.6f}};

// A blossom of a few broad petals, seen from its side and a little from above.
struct Bloom {
    glm::vec2 at;  // middle of its mouth
    float radius;
    glm::vec3 color, eye;
};
// Distance to its edge as leafEdge; color: where it covers p. The farther petals stand up behind its eye, into which
// one looks; the nearer ones are a cup before it, whose rim dips where two of them meet.
float bloomEdge(const Bloom& b, glm::vec2 p, glm::vec3& color) {
    const glm::vec2 d = (p - b.at) / b.radius;
    const float rim = 0.12f + 0.14f * std::cos(kPi * (d.x - 0.25f)), notch = 0.10f * std::abs(std::cos(4.2f * d.x));
    const float back = 1 - glm::length(d * glm::vec2(1, d.y < 0 ? 1.5f + notch : 1.1f));
    const float front = std::min(1 - glm::length(glm::vec2(d.x, 0.92f * d.y)), d.y - rim);
    if (front >= 0)
        color = b.color * (1.10f - 0.45f * ramp(0.1f, 1.0f, d.y) - 0.22f * ramp(0.16f, 0.02f, std::abs(d.x - 0.25f)));
    else if (back >= 0)
        color = glm::mix(b.color * 0.62f, b.color * 1.25f, ramp(0.0f, -0.6f, d.y));
    if (back >= 0 && front < 0 && glm::length((d - glm::vec2(0, rim - 0.10f)) * glm::vec2(1, 1.5f)) < 0.30f)
        color = b.eye;
    return std::max(back, front) * b.radius;
}

}  // namespace

float leafEdge(const Leaf& leaf, const Species& s, glm::vec2 p, float& across) {
    const glm::vec2 d = p - leaf.foot;
    const float along = glm::dot(d, leaf.along) / leaf.length;
    const float side = leaf.along.x * d.y - leaf.along.y * d.x;
    if (along < -0.3f || along > 1.3f) return -1;
    const float t = glm::clamp(along, 0.0f, 1.0f);
    float half = 0.5f * leaf.width;
    if (!leaf.stem) half *= std::pow(std::max(std::sin(kPi * std::pow(t, 0.75f)), 0.0f), 0.8f);
    half *= 1 + s.serrated * std::sin(60 * t);
    across = half > 1e-5f ? side / half : 0;
    const float beyond = std::max(-along, along - 1) * leaf.length;
    return std::min(half - std::abs(side), -beyond);
}

glm::vec3 leafColor(const Leaf& leaf, const Species& s, float edge, float across) {
    glm::vec3 color = glm::mix(s.dark, s.light, leaf.bright);
    color *= 0.86f + 0.20f * across * (leaf.bright > 0.5f ? 1.0f : -1.0f);  // one half towards the light
    color = glm::mix(color, s.light * 1.25f, 0.35f * ramp(0.16f, 0.03f, std::abs(across)));
    return color * (0.72f + 0.28f * ramp(0.0f, 0.010f, edge));  // the next leaf's shadow
}

void putTexel(uint8_t* texel, glm::vec3 color, float edge, int side) {
    for (int k = 0; k < 3; ++k) texel[k] = toByte(srgbOfLinear(color[k]));
    texel[3] = uint8_t(saturate(0.5f + edge * float(side) / 10) * 255 + 0.5f);
}

bool overLeaves(const std::vector<Leaf>& leaves, const Species& s, glm::vec2 p, float& edge, glm::vec3& color) {
    bool covered = false;
    for (const Leaf& leaf : leaves) {
        float across = 0;
        const float e = leafEdge(leaf, s, p, across);
        edge = std::max(edge, e);
        covered = covered || e >= 0;
        if (e >= 0) color = leafColor(leaf, s, e, across);
    }
    return covered;
}

// A clump of narrow leaves about its foot, blossoms on stems above them.
void paintFlowers(Picture& picture, int x0, int y0, int side, int kind, uint32_t salt) {
    const Blossom& b = kBlossoms[kind];
    const Species green{0.30f, 0.055f, 0, 0, {0.030f, 0.055f, 0.018f}, {0.090f, 0.130f, 0.040f}, 0};
    std::vector<Leaf> leaves;
    for (uint32_t i = 0; i < 46; ++i) {
        const auto random = [&](uint32_t which) { return random01(salt, i, which); };
        const float turn = 2.2f * (random(1) - 0.5f), size = 0.7f + 0.6f * random(2);
        const glm::vec2 foot(0.5f + 0.5f * (random(3) - 0.5f), 0.97f - 0.25f * random(4));
        leaves.push_back(
            {foot, {std::sin(turn), -std::cos(turn)}, green.length * size, green.width * size, random(5), 0});
    }
    std::vector<glm::vec2> blossoms;
    for (uint32_t i = 0; i < uint32_t(b.count); ++i) {
        const glm::vec2 at(0.12f + 0.76f * random01(salt + 31, i, 0), 0.10f + 0.48f * random01(salt + 31, i, 1));
        const glm::vec2 foot(glm::mix(0.5f, at.x, 0.35f), 0.9f);
        blossoms.push_back(at);
        leaves.push_back({foot, glm::normalize(at - foot), glm::distance(at, foot), kStem, 0.3f, 0, true});
    }
    for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x) {
            const glm::vec2 p = (glm::vec2(x, y) + 0.5f) / float(side);
            glm::vec3 color = green.dark;
            float edge = -1;
            overLeaves(leaves, green, p, edge, color);
            for (uint32_t i = 0; i < blossoms.size(); ++i) {
                const glm::vec2 d = (p - blossoms[i]) / b.radius * glm::vec2(1, 1 + b.tilt * random01(salt + 31, i, 2));
                const float far = glm::length(d), e = 1 + 0.18f * std::cos(8 * std::atan2(d.y, d.x)) - far;
                edge = std::max(edge, e * b.radius);
                if (e >= 0) color = (far < 0.35f ? b.middle : b.petals) * (0.92f - 0.2f * d.y);
            }
            putTexel(picture.at(x0 + x, y0 + y), color, edge, side);
        }
}

// Blades and stems that lean apart and end in ears, in places yellow; between them, if it blooms, a few poppies and
// buttercups.
void paintMeadow(Picture& picture, int x0, int y0, int side, bool blooms, uint32_t salt) {
    const Species grass{1, 1, 0, 0, {0.040f, 0.060f, 0.022f}, {0.124f, 0.148f, 0.060f}, 0};
    const glm::vec3 poppy(0.46f, 0.040f, 0.024f), buttercup(0.56f, 0.42f, 0.04f);
    const glm::vec3 dark(0.020f, 0.014f, 0.018f), gold(0.42f, 0.26f, 0.03f);
    std::vector<Leaf> leaves;
    std::vector<Bloom> flowers;
    for (uint32_t i = 0; i < 74; ++i) {
        const auto random = [&](uint32_t which) { return random01(salt, i, which); };
        const bool stem = i % 4 == 3;
        const float aside = 2 * random(3) - 1, turn = 0.42f * aside + 0.5f * (random(1) - 0.5f);
        const float length =
            (stem ? 0.50f + 0.42f * random(2) : 0.26f + 0.40f * random(2)) * (1 - 0.35f * aside * aside);
        const glm::vec2 foot(0.5f + 0.30f * aside, 1.0f), along(std::sin(turn), -std::cos(turn));
        const glm::vec2 tip = foot + length * along;
        leaves.push_back({foot, along, length, stem ? kStem : 0.034f, random(5), 0, stem});
        if (stem && blooms && i % 20 == 3)
            flowers.push_back(i % 40 == 3 ? Bloom{tip, 0.046f, poppy, dark} : Bloom{tip, 0.030f, buttercup, gold});
        else if (stem)  // an ear
            leaves.push_back({tip - 0.05f * along, along, 0.14f, 0.034f, 0.6f + 0.4f * random(6), 0});
    }
    for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x) {
            const glm::vec2 p = (glm::vec2(x, y) + 0.5f) / float(side);
            glm::vec3 color = grass.dark;
            float edge = -1;
            if (overLeaves(leaves, grass, p, edge, color)) color *= 0.75f + 0.25f * ramp(1.0f, 0.5f, p.y);
            for (const Bloom& b : flowers) {
                edge = std::max(edge, bloomEdge(b, p, color));
            }
            putTexel(picture.at(x0 + x, y0 + y), color, edge, side);
        }
}

// Three leaflets on each stalk, a pale arc across them, seen from above and aside; a few white heads over them.
void paintClover(Picture& picture, int x0, int y0, int side, uint32_t salt) {
    constexpr uint32_t kLeaves = 54, kHeads = 2;
    const glm::vec3 dark(0.020f, 0.038f, 0.014f), light(0.058f, 0.090f, 0.034f);
    const auto random = [&](uint32_t i, uint32_t which) { return random01(salt, i, which); };
    for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x) {
            const glm::vec2 p = (glm::vec2(x, y) + 0.5f) / float(side);
            glm::vec3 color = dark;
            float edge = -1;
            for (uint32_t i = 0; i < kLeaves; ++i) {  // the lower before the upper
                const float high = float(i) / kLeaves, wide = 0.40f * std::sqrt(1 - 0.6f * high);
                const glm::vec2 at(0.5f + wide * (2 * random(i, 1) - 1), 0.36f + 0.54f * (1 - high) * random(i, 2));
                for (uint32_t k = 0; k < 3; ++k) {
                    const float turn = 2.0944f * float(k) + 6.28f * random(i, 3);
                    const glm::vec2 out(std::sin(turn), std::cos(turn));
                    const glm::vec2 d = (p - at) * glm::vec2(1, 1.45f) - 0.046f * out;
                    const float e = 0.046f - glm::length(d), along = glm::dot(d, out) / 0.046f;
                    edge = std::max(edge, e);
                    const float arc = ramp(0.22f, 0.08f, std::abs(along - 0.1f));
                    if (e >= 0) color = glm::mix(dark, light, 0.25f + 0.5f * high + 0.25f * random(i, 4) + 0.2f * arc);
                    if (e >= 0) color *= 0.72f + 0.28f * ramp(0.0f, 0.014f, e);  // the next leaflet's shadow
                }
            }
            for (uint32_t i = 0; i < kHeads; ++i) {
                const glm::vec2 d = p - glm::vec2(0.16f + 0.68f * random(i, 5), 0.16f + 0.26f * random(i, 6));
                const float head = 0.042f - glm::length(d), stalk = d.y > 0 ? 0.5f * kStem - std::abs(d.x) : -1.0f;
                if (stalk >= 0 && edge < 0) color = light;
                edge = std::max({edge, head, d.y < 0.3f ? stalk : -1.0f});
                if (head >= 0) color = glm::vec3(0.44f, 0.42f, 0.36f) * (0.9f - 6 * d.y + 0.2f * std::sin(300 * d.x));
            }
            putTexel(picture.at(x0 + x, y0 + y), color, edge, side);
        }
}

}  // namespace espalier::content
