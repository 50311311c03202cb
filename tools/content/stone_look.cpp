// Relief and colour of old stonework. In: a point's place among stones and its surroundings. Out: how far it
// stands out of the block-out, and its colour: stones that differ, lime mortar, weathering, lichen and moss.

#include <algorithm>
#include <cmath>

#include "tools/content/masonry.hpp"
#include "tools/content/maths.hpp"
#include "tools/content/noise.hpp"

namespace espalier::content {
namespace {

constexpr float kMortarHalfWidth = 0.010f;
constexpr float kBevel = 0.034f;
constexpr float kMortarDepth = 0.032f;
constexpr float kEdgeRound = 0.055f;

// 1 at x = 0 down to 0 at x >= 1, like a rounded edge.
float roundDrop(float x) {
    float t = 1 - saturate(x);
    return 1 - std::sqrt(std::max(0.0f, 1 - t * t));
}

glm::vec3 stoneColor(uint32_t id, const StoneLook& look, float bump) {
    static const glm::vec3 kStones[] = {{0.265f, 0.222f, 0.160f}, {0.215f, 0.195f, 0.165f}, {0.290f, 0.235f, 0.160f},
                                        {0.175f, 0.165f, 0.148f}, {0.235f, 0.185f, 0.132f}, {0.270f, 0.246f, 0.204f}};
    glm::vec3 color = kStones[id % 6u];
    color *= 0.82f + 0.32f * random01(id, 5);
    float grain = fractal(look.block * 38.0f, 301, 3), cloud = fractal(look.block * 5.0f, 305, 3);
    color *= 1 + 0.20f * grain + 0.22f * cloud;
    color *= 1 + 6.0f * glm::clamp(bump, -0.03f, 0.02f);
    return color;
}

// Grey and ochre crusts, lobed and broken, in patches over some stones: few large ones among many small.
void addLichen(glm::vec3& color, const StoneLook& look, uint32_t id) {
    const float patch = ramp(-0.12f, 0.35f, fractal(look.block * 1.9f, 337, 2) + 0.5f * (random01(id, 8) - 0.5f));
    const glm::vec2 bent = glm::vec2(fractal(look.block * 11.0f, 331, 2), fractal(look.block * 11.0f, 332, 2)) * 0.35f;
    const float lobes = 0.20f * fractal(look.block * 42.0f, 335, 3);
    const float crust = ramp(-0.35f, 0.10f, fractal(look.block * 85.0f, 339, 2));
    for (const float often : {8.0f, 19.0f}) {
        const Cells spot = cells(look.st * often + bent, 333);
        const float size = 0.20f + 0.34f * random01(spot.id, 3) * random01(spot.id, 5);
        const float inside = ramp(size, size * 0.45f, spot.nearest + lobes);
        const float present = random01(spot.id, 4) < 0.75f * patch ? 1.0f : 0.0f;
        const glm::vec3 tone =
            random01(spot.id, 9) < 0.18f ? glm::vec3(0.30f, 0.20f, 0.06f) : glm::vec3(0.34f, 0.34f, 0.28f);
        color = glm::mix(color, tone, 0.62f * inside * crust * present);
    }
}

}  // namespace

Detail stoneDetail(const StonePlace& place, const StoneLook& look) {
    Detail out;
    uint32_t id = place.id;
    float chip = 0.5f + 0.5f * fractal(look.block * 7.0f, 311, 3);
    float bevel = kBevel * (0.55f + 0.9f * chip);
    float inJoint = roundDrop((place.joint - kMortarHalfWidth) / bevel);
    float loose = ramp(0.7f, 0.05f, look.belowCrest);  // stones near a crest have moved
    float standOut = (random01(id, 1) - 0.5f) * (0.034f + 0.045f * loose);
    if (random01(id, 2) < 0.10f) standOut -= 0.035f;  // weathered back
    standOut *= look.shift;
    glm::vec2 tilt = (glm::vec2(random01(id, 3), random01(id, 4)) - 0.5f) * (0.05f + 0.12f * loose);
    float coarse = fractal(look.block * 6.5f, 321, 3) * 0.013f;
    float fine = fractal(look.block * 30.0f, 325, 3) * 0.0042f;
    float pit = ramp(0.30f, 0.75f, fractal(look.block * 17.0f, 327, 2)) * -0.011f;
    float face = (standOut + glm::dot(tilt, place.local)) + (coarse + fine + pit) * look.roughness;
    float mortar = -kMortarDepth + 0.008f * fractal(look.block * 22.0f, 329, 3);
    out.height = glm::mix(face, mortar, saturate(inJoint));
    const float broken = 1 + 1.6f * std::pow(random01(id, 6), 3.0f);  // few stones have lost a corner
    out.height -=
        0.026f * broken * (0.6f + 0.8f * chip) * roundDrop(place.edge / (kEdgeRound * broken * (0.6f + 0.9f * chip)));

    glm::vec3 color = stoneColor(id, look, coarse + fine * 2 + pit * 1.5f);
    addLichen(color, look, id);
    glm::vec3 lime = glm::vec3(0.25f, 0.22f, 0.17f) * (1 + 0.35f * fractal(look.block * 50.0f, 341, 2));
    float open = ramp(0.55f, 0.98f, inJoint);
    color = glm::mix(color, lime * 0.82f, open);
    color *= 1 - 0.28f * ramp(0.05f, 0.9f, inJoint);     // the joint's own shade
    color *= 1 + 0.22f * roundDrop(place.edge / 0.03f);  // worn edges are paler
    float streak = ramp(0.0f, 0.7f, fractal(glm::vec2(look.st.x * 7.0f, look.st.y * 0.55f), 351, 3));
    color *= 1 - 0.55f * streak * ramp(2.2f, 0.0f, look.belowCrest);
    float soot = ramp(0.0f, 0.55f, fractal(look.block * 1.1f, 353, 3));
    color = glm::mix(color, color * glm::vec3(0.60f, 0.58f, 0.56f), 0.7f * soot);
    float damp = ramp(0.75f, 0.0f, look.aboveGround + 0.35f * fractal(look.block * 2.3f, 355, 3));
    color = glm::mix(color, color * glm::vec3(0.50f, 0.50f, 0.43f), 0.85f * damp);
    float patch = fractal(look.block * 3.7f, 361, 4);
    float moss = ramp(0.10f, 0.42f, patch + 0.45f * damp + 0.55f * look.upward + 0.22f * inJoint - 0.32f);
    float tuft = 0.5f + 0.5f * fractal(look.block * 70.0f, 365, 2);
    glm::vec3 green = glm::mix(glm::vec3(0.038f, 0.046f, 0.016f), glm::vec3(0.105f, 0.108f, 0.035f), tuft);
    color = glm::mix(color, green, 0.85f * moss);
    out.height += 0.006f * moss * (0.4f + tuft);
    out.albedo = glm::clamp(color, 0.004f, 0.85f);
    return out;
}

}  // namespace espalier::content
