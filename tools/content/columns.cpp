// The court's columns and fallen stones. In: profiles. Out: charts and footprints.

#include <cmath>

#include "tools/content/maths.hpp"
#include "tools/content/noise.hpp"
#include "tools/content/pillar.hpp"

namespace espalier::content {
namespace {

// An Attic base on a plinth: torus, scotia and a smaller torus, fillets between them, then the shaft's apophyge.
std::vector<std::vector<Ring>> baseBands() {
    std::vector<Ring> base{{0.24f, 0.425f, 1}, {0.245f, 0.40f, 0.5f}, {0.25f, 0.372f, 0}};
    auto round = [&](float y, float r, float bulge, int pieces) {
        Ring from = base.back();
        for (int i = 1; i <= pieces; ++i) {
            float t = static_cast<float>(i) / static_cast<float>(pieces);
            base.push_back({glm::mix(from.y, y, t), glm::mix(from.r, r, t) + bulge * std::sin(3.14159265f * t), 0});
        }
    };
    round(0.365f, 0.368f, 0.045f, 4);
    base.push_back({0.375f, 0.352f, 0});
    round(0.465f, 0.325f, -0.030f, 4);
    base.push_back({0.475f, 0.335f, 0});
    round(0.555f, 0.325f, 0.030f, 3);
    base.push_back({0.57f, 0.310f, 0});
    base.push_back({0.62f, 0.295f, 0});
    return {{{0, 0.44f, 1}, {0.20f, 0.44f, 1}, {0.24f, 0.425f, 1}}, base};
}

// Sixteen flutes with sharp ridges between them, worn towards the ends of the shaft.
float flutes(glm::vec2 q, float y) {
    constexpr float kTurn = 2 * 3.14159265f;
    float phase = std::atan2(q.x, q.y) * 16 / kTurn;
    float x = 2 * (phase - std::floor(phase + 0.5f)) / 0.86f;
    float groove = std::sqrt(std::max(0.0f, 1 - x * x));
    return -0.019f * groove * ramp(0.66f, 0.72f, y) * ramp(2.42f, 2.36f, y);
}

Pillar standingColumn() {
    Pillar p{"column", {2.3f, 1.95f}, 0.06f, baseBands(), 0, 0.4f, {0.24f, 1.22f, 1.83f, 2.44f}, {0.23f, 2.97f}, 48,
             31,       true};
    p.roughness = 0.35f;
    p.ringDistance = 0.12f;
    p.relief = flutes;
    p.shallow = true;
    p.bands.push_back({{0.62f, 0.295f, 0}, {1.2f, 0.29f, 0}, {1.8f, 0.275f, 0}, {2.44f, 0.25f, 0}});
    p.bands.push_back({{2.44f, 0.25f, 0},
                       {2.46f, 0.28f, 0},
                       {2.50f, 0.285f, 0},
                       {2.53f, 0.255f, 0},
                       {2.60f, 0.255f, 0},
                       {2.64f, 0.285f, 0},
                       {2.70f, 0.345f, 0},
                       {2.76f, 0.375f, 0.25f},
                       {2.79f, 0.395f, 1}});
    p.bands.push_back({{2.79f, 0.395f, 1}, {2.81f, 0.41f, 1}, {2.97f, 0.41f, 1}});
    return p;
}

Pillar brokenColumn() {
    Pillar p{"stump", {-1.2f, 1.95f}, -0.05f, baseBands(), 0.55f, 2.5f, {0.24f}, {0.23f}, 48, 53, false};
    p.roughness = 0.35f;
    p.ringDistance = 0.12f;
    p.relief = flutes;
    p.shallow = true;
    p.bands.push_back({{0.62f, 0.295f, 0}, {1.0f, 0.29f, 0}, {1.42f, 0.27f, 0}});
    return p;
}

Pillar lowStump() {
    Pillar p{"low stump", {3.2f, 3.3f}, 0.1f, baseBands(), 0.4f, 2.5f, {0.24f}, {0.23f}, 48, 57, false};
    p.roughness = 0.35f;
    p.ringDistance = 0.12f;
    p.relief = flutes;
    p.shallow = true;
    p.bands.push_back({{0.62f, 0.295f, 0}, {0.88f, 0.29f, 0}});
    return p;
}

Pillar fallenStone(const char* name, glm::vec2 foot, float turn, float halfWidth, float height, float tilt,
                   uint32_t salt) {
    return {
        name, foot,
        turn, {{{0, halfWidth * 1.04f, 0.9f}, {height * 0.8f, halfWidth, 0.9f}, {height, halfWidth * 0.93f, 0.85f}}},
        tilt, 0.6f,
        {},   {},
        32,   salt,
        false};
}

}  // namespace

void addColumns(std::vector<Chart>& charts, std::vector<Loop>& footprints) {
    addPillar(charts, footprints, standingColumn());
    addPillar(charts, footprints, brokenColumn());
    addPillar(charts, footprints, lowStump());
    addPillar(charts, footprints, urn());
    addPillar(charts, footprints, fallenStone("fallen stone 0", {3.45f, 1.0f}, 0.5f, 0.24f, 0.30f, 0.25f, 71));
    addPillar(charts, footprints, fallenStone("fallen stone 1", {-2.2f, 2.75f}, -0.35f, 0.27f, 0.26f, -0.20f, 72));
    addPillar(charts, footprints, fallenStone("fallen stone 2", {0.15f, 2.95f}, 0.9f, 0.20f, 0.20f, 0.3f, 73));
}

}  // namespace espalier::content
