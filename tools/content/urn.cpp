// The court's sculpture. In: nothing. Out: the profile and the carved work of a campana urn on its pedestal: a stepped
// plinth, a die with sunken panels and rosettes, a cornice, a waisted foot, a gadrooned bowl, a bell with a leaf
// frieze.

#include <cmath>

#include "tools/content/maths.hpp"
#include "tools/content/noise.hpp"
#include "tools/content/pillar.hpp"

namespace espalier::content {
namespace {

constexpr float kDieLow = 0.40f, kDieHigh = 0.98f, kDie = 0.325f;
constexpr float kBowlLow = 1.515f, kBowlHigh = 1.735f;
constexpr float kFriezeLow = 1.80f, kFriezeHigh = 2.08f;

using Band = std::vector<Ring>;

// A moulding from the band's last ring to (y, r) that bulges by `bulge` metres: out as a torus, in as a scotia.
void moulding(Band& band, float y, float r, float bulge, int pieces) {
    Ring from = band.back();
    for (int i = 1; i <= pieces; ++i) {
        float t = static_cast<float>(i) / static_cast<float>(pieces);
        band.push_back({glm::mix(from.y, y, t), glm::mix(from.r, r, t) + bulge * std::sin(kPi * t), from.square});
    }
}

// An S from the band's last ring to (y, r).
void cyma(Band& band, float y, float r, int pieces) {
    Ring from = band.back();
    for (int i = 1; i <= pieces; ++i) {
        float t = static_cast<float>(i) / static_cast<float>(pieces);
        band.push_back({glm::mix(from.y, y, t), glm::mix(from.r, r, t * t * (3 - 2 * t)), from.square});
    }
}

// A sunken panel with a moulded frame and a rosette of eight petals.
float panel(glm::vec2 face) {
    glm::vec2 half(kDie - 0.065f, (kDieHigh - kDieLow) / 2 - 0.065f);
    glm::vec2 in = half - glm::abs(face);
    float inside = std::min(in.x, in.y);
    float height = -0.020f * ramp(0, 0.022f, inside) + 0.010f * ramp(0.03f, 0.012f, std::abs(inside - 0.034f));
    float r = glm::length(face), angle = std::atan2(face.x, face.y);
    float petals = 0.118f + 0.032f * std::cos(8 * angle);
    float vein = 0.6f + 0.4f * std::abs(std::sin(4 * angle));
    height += 0.026f * vein * ramp(petals, petals - 0.035f, r) * ramp(0.034f, 0.05f, r);
    return height + 0.030f * std::sqrt(std::max(0.0f, 1 - r * r / (0.036f * 0.036f)));
}

// Upright lobes that end round; widest in the middle of the bowl.
float gadroons(float angle, float up) {
    float lobe = std::abs(std::sin(8 * angle));
    float ends = ramp(0.0f, 0.16f, up) * ramp(1.0f, 0.86f, up);
    return ends * (0.024f * std::sqrt(lobe) - 0.012f);
}

// Pointed leaves side by side, a rib in each, smaller ones behind.
float leaves(float angle, float up) {
    auto leaf = [&](float phase, float tall) {
        float x = angle * 12 / (2 * kPi) + phase;
        x = 2 * std::abs(x - std::floor(x) - 0.5f);  // 0 in the middle
        float wide = 0.86f * std::sqrt(std::max(0.0f, 1 - std::pow(up / tall, 2.2f)));
        float blade = up < tall ? ramp(wide, wide - 0.25f, x) : 0.0f;
        return blade *
               (0.65f + 0.35f * ramp(0.22f, 0.05f, x) - 0.25f * ramp(0.0f, 0.2f, std::sin(34 * (up - 0.5f * x)) * x));
    };
    return 0.016f * std::max(leaf(0, 0.95f), 0.6f * leaf(0.5f, 0.72f));
}

float carving(glm::vec2 q, float y) {
    float angle = std::atan2(q.x, q.y);
    if (y > kDieLow && y < kDieHigh) {
        glm::vec2 a = glm::abs(q);
        return panel({a.x > a.y ? q.y : q.x, y - (kDieLow + kDieHigh) / 2});
    }
    if (y > kBowlLow && y < kBowlHigh) return gadroons(angle, (y - kBowlLow) / (kBowlHigh - kBowlLow));
    if (y > kFriezeLow && y < kFriezeHigh) return leaves(angle, (y - kFriezeLow) / (kFriezeHigh - kFriezeLow));
    if (y > 2.245f && glm::length(q) > 0.42f) return 0.007f * std::cos(32 * angle);  // eggs on the lip
    return 0;
}

Band from(const Band& band) {
    return {band.back()};
}

}  // namespace

Pillar urn() {
    Pillar p;
    p.name = "urn";
    p.foot = {-0.75f, 3.55f};
    p.turn = 0.62f;
    p.edges = {0.168f};
    p.pieces = 64;
    p.salt = 63;
    p.ringDistance = 0.075f;
    p.dry = 0.3f;
    p.roughness = 0.26f;
    p.relief = carving;
    p.earthTop = true;
    Band plinth{{0, 0.49f, 1},       {0.15f, 0.49f, 1},   {0.165f, 0.487f, 1}, {0.171f, 0.476f, 1},
                {0.175f, 0.436f, 1}, {0.183f, 0.425f, 1}, {0.285f, 0.425f, 1}, {0.298f, 0.415f, 1}};
    cyma(plinth, 0.37f, kDie + 0.012f, 4);
    plinth.push_back({kDieLow, kDie, 1});
    Band die = from(plinth);
    die.push_back({kDieHigh, kDie, 1});
    Band cornice = from(die);
    cornice.push_back({1.00f, kDie + 0.02f, 1});
    cyma(cornice, 1.07f, 0.405f, 4);
    cornice.push_back({1.075f, 0.425f, 1});
    cornice.push_back({1.145f, 0.425f, 1});
    Band slab = from(cornice);
    slab.push_back({1.155f, 0.41f, 1});
    slab.push_back({1.172f, 0.255f, 1});
    Band socle = from(slab);
    socle.push_back({1.245f, 0.25f, 1});
    socle.push_back({1.255f, 0.235f, 0.85f});
    socle.push_back({1.262f, 0.218f, 0});
    moulding(socle, 1.315f, 0.20f, 0.022f, 4);
    Band foot = from(socle);
    foot.push_back({1.322f, 0.178f, 0});
    moulding(foot, 1.395f, 0.098f, -0.022f, 5);
    moulding(foot, 1.465f, 0.098f, 0, 2);
    moulding(foot, 1.500f, 0.104f, 0.024f, 4);
    Band bowl = from(foot);
    bowl.push_back({kBowlLow, 0.125f, 0});
    for (int i = 1; i <= 4; ++i) {
        float a = 0.5f * kPi * static_cast<float>(i) / 8;
        bowl.push_back({kBowlLow + 0.16f * (1 - std::cos(a)), 0.125f + 0.225f * std::sin(a), 0});
    }
    Band upper = from(bowl);
    for (int i = 5; i <= 8; ++i) {
        float a = 0.5f * kPi * static_cast<float>(i) / 8;
        upper.push_back({kBowlLow + 0.16f * (1 - std::cos(a)), 0.125f + 0.225f * std::sin(a), 0});
    }
    moulding(upper, kBowlHigh, 0.335f, 0.008f, 3);
    upper.push_back({1.745f, 0.315f, 0});
    upper.push_back({1.765f, 0.300f, 0});
    Band bell = from(upper);
    for (int i = 1; i <= 10; ++i) {
        float t = static_cast<float>(i) / 10;
        bell.push_back(
            {glm::mix(1.765f, 2.20f, t), 0.300f - 0.055f * std::sin(kPi * std::pow(t, 0.8f)) + 0.075f * t * t * t, 0});
    }
    Band lip = from(bell);
    moulding(lip, 2.245f, 0.425f, -0.014f, 4);
    moulding(lip, 2.295f, 0.43f, 0.022f, 4);
    lip.push_back({2.297f, 0.395f, 0});
    Band inside = from(lip);
    inside.push_back({2.27f, 0.365f, 0});
    inside.push_back({2.235f, 0.345f, 0});
    p.bands = {plinth, die, cornice, slab, socle, foot, bowl, upper, bell, lip, inside};
    return p;
}

}  // namespace espalier::content
