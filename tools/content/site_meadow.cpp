// The meadow between the court and the village. In: the plan, what stands already. Out: rails along the street,
// daisies, tufts, and grass that nobody mows.

#include <algorithm>
#include <cmath>

#include "tools/content/lawn.hpp"
#include "tools/content/maths.hpp"
#include "tools/content/noise.hpp"
#include "tools/content/site_layout.hpp"

namespace espalier::content {

using glm::vec2;

// Along the village's street, open where tracks and the path go through.
void Layout::paddocks() {
    const Line sides[] = {
        {{-9.9f, -16.8f}, {-10.3f, -22.2f}, {-16, -20.9f}, {-26.5f, -18.2f}},
        {{-31.0f, -16.6f}, {-34.5f, -11.5f}, {-37.3f, -1}},
        {{-4.3f, -20.4f}, {-3.2f, -24.6f}, {4.4f, -30.7f}, {13.5f, -31.7f}, {23.6f, -29.8f}, {31, -27}},
        {{35.6f, -24.3f}, {42, -19}, {46, -9.6f}, {40.6f, 3}}};
    for (const Line& side : sides)
        for (size_t i = 0; i + 1 < side.size(); ++i) row("rails", side[i], side[i + 1]);
}

// In the meadow about the court, and in patches wherever the village's grass isn't mown.
void Layout::daisies() {
    const auto flower = [&](const char* kind, vec2 p, uint32_t i, float least) {
        if (noise(p / 2.1f, 93) + 0.4f * noise(p / 0.6f, 94) > least && clear(p, 0.2f, 0.5f))
            put(kind, p, 360 * random01(i, 95), 0.32f + 0.3f * random01(i, 96), 0.02f);
    };
    const auto within = [](uint32_t i, float radius) {
        const float angle = 2 * kPi * random01(i, 91), r = radius * std::sqrt(random01(i, 92));
        return r * vec2(std::cos(angle), std::sin(angle));
    };
    for (uint32_t i = 0; i < 1500; ++i) flower("flowers_a", kCourt + within(i, 18), i, 0.38f);
    for (uint32_t i = 2000; i < 7000; ++i) flower("flowers_a", within(i, 60), i, 0.52f);
    // Lawns before houses: more of them, here and there blue ones.
    for (uint32_t i = 7000; i < 17000; ++i) {
        const vec2 p = within(i, 60);
        const float house = plan_.toHouse(p);
        if (house < 1 || house > 9) continue;
        flower(noise(p / 2.9f, 97) > 0.30f ? "flowers_c" : "flowers_a", p, i, 0.27f);
    }
}

// Where nobody mows: on both sides of tracks and rails, about trunks and what has been left lying or fenced in, and in
// islands; before the court, where pictures are taken from, only in the lawn's own, and low.
void Layout::tallGrass() {
    constexpr float kCell = 0.72f, kReach = 46;
    const vec2 middle(0, -12), before(1.8f, 8.5f);
    std::vector<SitePlace> rails = site_.props["rails"], left;
    for (const char* model : {"fence", "wall", "hedge", "cart", "bench", "rubble"})
        left.insert(left.end(), site_.props[model].begin(), site_.props[model].end());
    const auto placeOf = [](const SitePlace& p) { return vec2(p.position.x, p.position.z); };
    const auto nearest = [](vec2 p, const auto& all, auto at) {
        float best = 1e9f;
        for (const auto& one : all) best = std::min(best, glm::distance(p, at(one)));
        return best;
    };
    const int cells = int(kReach / kCell);
    for (int y = -cells; y <= cells; ++y)
        for (int x = -cells; x <= cells; ++x) {
            const uint32_t i = uint32_t((y + cells) * (2 * cells + 1) + x + cells);
            const vec2 p = middle + kCell * (vec2(x, y) + vec2(random01(i, 171), random01(i, 172)));
            if (glm::distance(p, middle) > kReach || !clear(p, 0.3f, 0.9f)) continue;
            const bool lawn = glm::distance(p, before) < 6.5f;
            if (lawn && random01(i, 178) > 0.8f * lawnAt(p).tall) continue;
            const float track = -plan_.trodden(p), kerb = -plan_.paved(p);
            if (track < 0.25f || nearest(p, site_.props["bench"], placeOf) < 1.1f) continue;  // one sits there
            const float rail = nearest(p, rails, placeOf), lying = nearest(p, left, placeOf);
            const float trunk = nearest(p, shades_, [](glm::vec3 s) { return vec2(s); });
            float wild = noise(p / 6.5f, 173) + 0.5f * noise(p / 2.1f, 174) - 0.70f;
            wild += 0.45f * ramp(1.2f, 0.5f, track) + 0.75f * ramp(1.3f, 0.4f, rail) + 0.7f * ramp(1.3f, 0.5f, trunk) +
                    0.7f * ramp(2.0f, 0.9f, lying) + 0.25f * ramp(1.6f, 0.5f, kerb);
            if (lawn) wild = 0.02f;
            if (wild < 0) continue;
            const char* model = noise(p / 3.1f, 175) > 0.22f ? "meadow_b" : "meadow_a";
            const float high = lawn ? 0.30f + 0.25f * random01(i, 177) : 0.48f + 0.36f * random01(i, 177);
            put(model, p, 360 * random01(i, 176), high + 0.45f * saturate(1.5f * wild),
                0.03f);  // lower towards the border
        }
}

// Grass stands higher where nobody mows or treads: at feet of what is built, along kerbs, around the court.
void Layout::tufts() {
    uint32_t index = 0;
    const auto tuft = [&](vec2 p, float most) {
        const uint32_t i = ++index;
        if (plan_.paved(p) > -0.12f || plan_.toHouse(p) < 0.1f || Plan::toCourt(p) < 0.15f) return;
        const float pick = random01(i, 61);
        put(pick < 0.4f    ? "tuft_a"
            : pick < 0.62f ? "tuft_b"
                           : "tuft_c",
            p, 360 * random01(i, 62), most * (0.7f + 0.6f * random01(i, 63)));
    };
    for (uint32_t i = 0; i < 24000; ++i) {
        const float angle = 2 * kPi * random01(i, 64), r = 22 * std::sqrt(random01(i, 65));
        const vec2 p = kCourt + r * vec2(std::cos(angle), std::sin(angle));
        const Lawn lawn = lawnAt(p);
        const float rank = noise(p / 1.7f, 66) + 0.5f * noise(p / 5.0f, 67) +
                           0.9f * ramp(1.8f, 0.3f, Plan::toCourt(p)) + 0.8f * lawn.tall - 1.2f * lawn.bare -
                           0.6f * lawn.clover;
        if (rank > 0.06f) tuft(p, 0.75f + 0.4f * saturate(rank - 0.3f));
    }
    const std::map<std::string, std::vector<SitePlace>> built = site_.props;
    for (const char* foot : {"wall", "pier", "fence", "rubble", "bench", "boards", "cart", "hives", "barrel"}) {
        const auto found = built.find(foot);
        if (found == built.end()) continue;
        for (const SitePlace& place : found->second)
            for (uint32_t i = 0; i < 5; ++i) {
                const float turn = place.degrees * kPi / 180, x = 2 * random01(index, i, 68) - 1,
                            side = (random01(index, i, 69) < 0.5f ? -1.0f : 1.0f) * 0.34f;
                tuft(vec2(place.position.x, place.position.z) + x * vec2(std::cos(turn), -std::sin(turn)) +
                         side * vec2(std::sin(turn), std::cos(turn)),
                     1.0f);
            }
    }
}

}  // namespace espalier::content
