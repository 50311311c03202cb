// What the village is strewn with. In: the plan. Out: trees and shrubs, and what pictures are composed with.

#include "tools/content/site_layout.hpp"

#include <algorithm>
#include <cmath>

#include "tools/content/maths.hpp"
#include "tools/content/noise.hpp"

namespace espalier::content {

using glm::vec2;

void Layout::lay() {
    feature();
    paddocks();
    yards();
    gardens();
    walls();
    trees();
    beds();
    daisies();
    shrubs();
    tallGrass();
    turf();
    tufts();
    feet();
    fallen();
}

void Layout::put(const std::string& model, vec2 at, float degrees, float scale, float sink) {
    site_.props[model].push_back({{at.x, kLevel - sink, at.y}, degrees, scale});
}

bool Layout::clear(vec2 p, float radius, float fromHouse) const {
    if (plan_.paved(p) > -radius || plan_.toHouse(p) < fromHouse || Plan::toCourt(p) < radius + 0.5f) return false;
    if (plan_.trodden(p) > -0.5f * radius) return false;
    return std::all_of(taken_.begin(), taken_.end(),
                       [&](glm::vec3 t) { return glm::distance(p, vec2(t)) > radius + t.z; });
}

void Layout::tree(const std::string& model, vec2 at, float scale, float radius, uint32_t turn) {
    put(model, at, 360 * random01(turn, 19), scale, 0.05f);
    taken_.push_back({at, radius});
    shades_.push_back({at, radius});
}

// What the sample's pictures are composed with.
void Layout::feature() {
    tree("lime_b", {-13.5f, -9.5f}, 0.92f, 3.0f, 1);
    tree("lime_a", {12.5f, -14.0f}, 0.95f, 2.6f, 2);
    tree("birch_a", {9.4f, -5.2f}, 0.86f, 1.2f, 3);
    tree("birch_a", {11.2f, -3.8f}, 0.70f, 1.0f, 4);
    tree("apple_a", {-12.0f, 6.5f}, 1.0f, 1.6f, 5);
    tree("apple_b", {-16.5f, 12.5f}, 1.0f, 1.7f, 6);
    tree("apple_a", {-19.5f, 5.0f}, 0.9f, 1.6f, 7);
    tree("lime_a", {15.5f, 12.5f}, 0.85f, 2.6f, 8);
    for (vec2 p : {vec2(-6.6f, -1.9f), vec2(7.1f, -1.3f), vec2(-8.4f, -3.9f), vec2(6.9f, 6.6f)})
        put(p.x < 0 ? "bush_a" : "bush_b", p, 40 * p.x, 0.85f + 0.03f * std::abs(p.y), 0.05f);
    put("bush_b", {-5.9f, -2.9f}, 70, 0.8f, 0.05f);
    put("bush_b", {-7.6f, -0.7f}, 10, 0.7f, 0.05f);
    put("rubble", {6.9f, 0.4f}, 20, 1, 0.03f);
    put("rubble", {-5.4f, 5.9f}, 130, 0.8f, 0.04f);
    // Where the path's kerbs end at the court's older paving.
    for (uint32_t i = 0; i < 12; ++i) {
        const vec2 end(0.6f + (i % 2 ? 0.95f : -0.95f) + 0.36f * (random01(i, 207) - 0.5f),
                       -1.75f - 0.55f * random01(i, 208));
        put("meadow_a", end, 360 * random01(i, 209), 0.22f + 0.26f * random01(i, 210), 0.03f);
    }
    put("bench", {-3.1f, -8.3f}, 62, 1);
    put("bench", {-5.3f, -31.0f}, 29, 1);
    tree("apple_b", {-7.6f, -33.6f}, 0.85f, 1.6f, 9);
    put("cart", {6.4f, -42.2f}, 118, 1);
    taken_.push_back({6.4f, -42.2f, 1.6f});
    lawnBefore({9.4f, -40.9f}, glm::normalize(vec2(6.1f, 6.0f)));
    lawnBefore({-5.2f, -38.4f}, glm::normalize(vec2(5.2f, 6.1f)));
    put("trough", kSquare + vec2(2.5f, 1.3f), 62, 1);
    put("well", kSquare + vec2(0.2f, 0.4f), 25, 1);
    taken_.push_back({kSquare, 2});
}

// A bed of flowers between two shrubs, on a lawn before a wall that faces `out`.
void Layout::lawnBefore(vec2 at, vec2 out) {
    const vec2 along(out.y, -out.x);
    if (!place("boards", at, out, 1.48f, 1.48f)) return;
    plantBed(at, along, out, 7);
    for (uint32_t i : {0u, 1u}) {
        const vec2 p = at + (i ? 2.2f : -2.2f) * along;
        if (!clear(p, 0.6f, 0.9f)) continue;
        put("bush_b", p, 360 * random01(i, 202), 0.45f + 0.2f * random01(i, 203), 0.05f);
        taken_.push_back({p, 0.6f});
    }
}

void Layout::trees() {
    // Along streets, in groups between the houses and, ever denser, behind them, so that the village lies among
    // trees.
    for (uint32_t i = 0; i < 3200; ++i) {
        const float angle = 2 * kPi * random01(i, 41), r = 16 + 84 * std::pow(random01(i, 42), 0.7f);
        const vec2 p(r * std::cos(angle), r * std::sin(angle));
        const float grove = noise(p / 17.0f, 43), chance = r < 34 ? 0.02f : r < 62 ? 0.06f : 0.30f;
        if (random01(i, 44) > chance + 0.34f * std::max(grove, 0.0f) * ramp(26, 60, r)) continue;
        const bool tall = random01(i, 45) < 0.55f;
        if (!clear(p, tall ? 3.2f : 2.0f, tall ? 4.5f : 3.0f)) continue;
        const float pick = random01(i, 46);
        const char* model = !tall          ? (pick < 0.5f ? "apple_a" : "birch_a")
                            : pick < 0.4f  ? "lime_a"
                            : pick < 0.75f ? "lime_b"
                                           : "birch_a";
        tree(model, p, 0.8f + 0.5f * random01(i, 47), tall ? 3.2f : 1.6f, i + 500);
    }
}

void Layout::shrubs() {
    for (uint32_t i = 0; i < 2600; ++i) {
        const vec2 p = kHalfMap * 0.9f * (2.0f * vec2(random01(i, 51), random01(i, 52)) - 1.0f);
        const float house = plan_.toHouse(p), grove = noise(p / 9.0f, 53);
        // At the feet of walls, and in groves.
        const float chance = house > 0.5f && house < 1.6f ? 0.55f : glm::length(p) > 22 && grove > 0.45f ? 0.10f : 0.0f;
        if (random01(i, 54) > chance || !clear(p, 0.9f, 0.5f)) continue;
        put(random01(i, 55) < 0.5f ? "bush_a" : "bush_b", p, 360 * random01(i, 56), 0.6f + 0.6f * random01(i, 57),
            0.05f);
        taken_.push_back({p, 0.7f});
    }
}

}  // namespace espalier::content
