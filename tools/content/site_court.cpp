// The court and the lawn about it. In: the plan, what stands already. Out: short grass and clover, grass at the feet of
// its walls, stones that fell from them.

#include <algorithm>
#include <cmath>
#include <iterator>

#include "tools/content/lawn.hpp"
#include "tools/content/maths.hpp"
#include "tools/content/noise.hpp"
#include "tools/content/ruin.hpp"
#include "tools/content/site_layout.hpp"

namespace espalier::content {

using glm::vec2;

namespace {

// Metres that what stands on the court's own ground has to sink below the meadow, negative as that is higher.
float courtSink(vec2 p) {
    return kLevel - groundHeight(p) + 0.01f;
}

}  // namespace

// Short grass in the court and around it, thinner farther away, none on bare earth; clover in its patches.
void Layout::turf() {
    constexpr float kCell = 0.29f, kTurfReach = 15;
    const int cells = int(kTurfReach / kCell);
    for (int y = -cells; y <= cells; ++y)
        for (int x = -cells; x <= cells; ++x) {
            const uint32_t i = uint32_t((y + cells) * (2 * cells + 1) + x + cells);
            const vec2 p = kCourt + kCell * (vec2(x, y) + 0.9f * vec2(random01(i, 191), random01(i, 192)));
            const bool court = Plan::toCourt(p) < 0.1f;
            const float thin = glm::distance(p, kCourt) / kTurfReach;
            const bool grows = court ? grassShare(p) > 0.35f && footDistance(p) > 0.2f
                                     : thin + 0.5f * noise(p / 1.9f, 193) < 0.95f && plan_.trodden(p) < -0.2f;
            const Lawn lawn = lawnAt(p);
            if (!grows || plan_.paved(p) > -0.2f || random01(i, 196) < lawn.bare) continue;
            const float turn = 360 * random01(i, 194), size = random01(i, 195);
            if (!court && random01(i, 197) < lawn.clover)
                put("clover", p, turn, 0.7f + 0.6f * size, 0.01f);
            else
                put("turf", p, turn, 0.7f + 0.5f * size + 0.3f * lawn.tall, court ? courtSink(p) : 0);
        }
}

// Where a wall keeps feet and scythes off: clumps of any size between single blades, lower the farther from the wall.
void Layout::feet() {
    for (uint32_t i = 0; i < 11000; ++i) {
        const vec2 p = kCourt + 1.1f * kCourtHalf * (2.0f * vec2(random01(i, 181), random01(i, 182)) - 1.0f);
        const float foot = footDistance(p);
        if (foot < 0.015f || foot > 0.45f || pavedShare(p) > 0.2f) continue;
        const float clump = noise(p / 0.75f, 183) + 0.7f * noise(p / 0.24f, 189);
        const float dense = 0.50f + 0.45f * clump - 1.3f * std::max(foot - 0.12f, 0.0f);
        if (random01(i, 190) > std::max(dense, foot < 0.22f ? 0.26f : 0.0f)) continue;
        const float lush = saturate(0.5f + 0.5f * clump), own = random01(i, 186), turn = 360 * random01(i, 185);
        // Mostly a few blades; sheaves among them, as high as a hand or a knee, so that no wall meets the ground in a
        // line.
        if (foot > 0.05f && foot < 0.32f && random01(i, 187) < 0.10f + 0.22f * lush)
            put(lush > 0.75f && random01(i, 188) < 0.12f ? "meadow_b" : "meadow_a", p, turn,
                0.20f + (0.10f + 0.34f * lush) * random01(i, 198), courtSink(p));
        else
            put(own > 0.75f  ? "tuft_b"
                : own > 0.4f ? "tuft_a"
                             : "tuft_c",
                p, turn, 0.55f + (0.30f + 0.55f * lush) * random01(i, 184), courtSink(p));
    }
    // The end of the eastern wall lies before the eye that looks into the court.
    for (uint32_t i = 0; i < 9; ++i) {
        const vec2 p = vec2(3.9f + 0.78f * random01(i, 216), 4.24f + 0.30f * random01(i, 217) * random01(i, 218));
        put("meadow_a", p, 360 * random01(i, 219), 0.16f + 0.30f * random01(i, 220), courtSink(p));
    }
}

// Stones that fell from the walls, half sunk, the smaller ones farther away.
void Layout::fallen() {
    const vec2 heaps[] = {{4.3f, 4.75f}, {5.2f, 2.2f}, {-4.1f, 1.4f}, {-3.3f, 3.9f}, {2.4f, -1.0f}, {-2.6f, -1.2f}};
    for (uint32_t heap = 0; heap < std::size(heaps); ++heap)
        for (uint32_t k = 0; k < 4; ++k) {
            const uint32_t i = heap * 8 + k;
            const float angle = 6.28f * random01(i, 211), far = 0.25f + 0.9f * float(k) * random01(i, 212);
            const vec2 p = heaps[heap] + far * vec2(std::cos(angle), std::sin(angle));
            if (footDistance(p) < 0.25f || pavedShare(p) > 0.2f || plan_.paved(p) > -0.3f) continue;
            put(random01(i, 213) < 0.5f ? "stone_a" : "stone_b", p, 360 * random01(i, 214),
                (k == 0 ? 0.9f : 0.5f) + 0.3f * random01(i, 215), 0.03f);
        }
}

}  // namespace espalier::content
