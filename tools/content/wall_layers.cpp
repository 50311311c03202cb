// Layers of the ruin's walls, as functions of the place.
#include "tools/content/wall_layers.hpp"

#include <algorithm>
#include <cmath>
#include <span>

#include "tools/content/maths.hpp"
#include "tools/content/noise.hpp"

namespace espalier::content {
namespace {

// A tongue of ivy up a wall, as wide as `foot` where it begins and ever narrower.
struct Tongue {
    std::vector<glm::vec2> line;
    float foot = 0, tip = 0;  // half widths, metres
};

// Metres from the tongue's border, negative inside.
float tongueDistance(glm::vec2 p, const Tongue& tongue) {
    float best = 1e9f;
    const float pieces = static_cast<float>(tongue.line.size() - 1);
    for (size_t i = 0; i + 1 < tongue.line.size(); ++i) {
        glm::vec2 d = tongue.line[i + 1] - tongue.line[i];
        float t = saturate(glm::dot(p - tongue.line[i], d) / glm::dot(d, d));
        float along = (static_cast<float>(i) + t) / pieces;
        best = std::min(best, glm::distance(p, tongue.line[i] + d * t) - glm::mix(tongue.foot, tongue.tip, along));
    }
    return best;
}

// Ivy within tongues, thinner towards their ragged borders.
float tongues(glm::vec2 p, std::span<const Tongue> all) {
    float d = 1e9f;
    for (const Tongue& tongue : all) d = std::min(d, tongueDistance(p, tongue));
    d += 0.34f * fractal(p * 1.6f, 489, 3) + 0.12f * fractal(p * 6.0f, 490, 2);
    return 0.72f * ramp(0.16f, -0.26f, d);
}

}  // namespace

float mainMask(glm::vec2 p, const Elevation& wall) {
    std::vector<glm::vec2> stroke{{-1.35f, -0.2f}, {-1.25f, 0.6f}, {-0.95f, 1.2f}};
    const Arch& arch = wall.arch();
    for (int k = 0; k <= 16; ++k) {
        float a = 3.14159265f * static_cast<float>(k) / 16, r = arch.halfWidth + 0.22f;
        stroke.push_back({arch.centre - r * std::cos(a), arch.spring + r * std::sin(a)});
    }
    stroke.push_back({1.85f, 0.9f});
    stroke.push_back({2.0f, -0.2f});
    float d = tongueDistance(p, {stroke});
    d = std::min(d, tongueDistance(p, {{{-1.1f, 0.9f}, {-1.75f, 1.7f}, {-1.6f, 2.5f}, {-2.2f, 3.2f}}}));
    return ramp(0.26f, 0.20f, d + 0.05f * fractal(p * 4.0f, 481, 2));
}

float frontIvy(glm::vec2 p, const Elevation& wall) {
    const Arch& arch = wall.arch();
    float r = glm::distance(p, glm::vec2(arch.centre, arch.spring));
    float over = ramp(0.34f, 0.18f, std::abs(r - arch.halfWidth - 0.25f)) * ramp(-0.1f, 0.3f, p.y - arch.spring);
    float bare =
        ramp(kTondoRadius + 0.02f, kTondoRadius + 0.10f, glm::distance(p, kTondo) + 0.03f * fractal(p * 5.0f, 487, 2));
    return bare * glm::mix(0.5f, 0.85f, over);
}

float backIvy(glm::vec2 p) {
    static const Tongue kTongues[] = {
        // A curtain that leans over to the corner, and what hangs from the coping.
        {{{-1.6f, -0.2f}, {-1.45f, 0.7f}, {-1.85f, 1.5f}, {-1.65f, 2.3f}, {-2.15f, 3.0f}, {-2.3f, 3.8f}}, 0.62f, 0.36f},
        {{{-1.5f, 0.6f}, {-0.95f, 1.3f}, {-0.75f, 2.2f}, {-0.2f, 2.7f}}, 0.46f, 0.12f},
        {{{-3.2f, -0.2f}, {-3.3f, 0.9f}, {-3.1f, 1.8f}, {-3.25f, 2.9f}}, 0.46f, 0.16f},
        {{{-3.1f, 0.3f}, {-2.6f, 0.9f}, {-2.45f, 1.9f}, {-2.2f, 2.7f}}, 0.34f, 0.16f},
        {{{-2.6f, 3.7f}, {-1.7f, 3.55f}, {-0.9f, 3.1f}}, 0.26f, 0.14f},
        // Over the arch, from its pier.
        {{{2.3f, -0.2f}, {2.1f, 1.0f}, {1.75f, 2.2f}, {1.1f, 2.75f}, {0.4f, 2.9f}, {-0.3f, 2.8f}}, 0.58f, 0.18f},
        {{{0.1f, 3.1f}, {0.05f, 2.4f}, {0.2f, 1.9f}}, 0.20f, 0.04f},
        {{{-0.25f, 0.1f}, {-0.3f, 1.0f}, {-0.5f, 1.8f}}, 0.26f, 0.08f}};
    return tongues(p, kTongues);
}

float outerIvy(glm::vec2 p) {
    static const Tongue kTongues[] = {
        {{{1.5f, -0.2f}, {1.3f, 0.8f}, {1.0f, 1.5f}, {0.75f, 2.2f}, {0.3f, 2.9f}, {0.2f, 3.6f}}, 0.62f, 0.14f},
        {{{0.6f, -0.2f}, {0.45f, 0.7f}, {0.1f, 1.3f}, {-0.05f, 1.9f}}, 0.36f, 0.10f},
        {{{1.9f, 0.2f}, {1.95f, 0.8f}, {1.75f, 1.3f}, {1.6f, 1.9f}}, 0.40f, 0.14f},
        {{{1.2f, 1.2f}, {1.35f, 1.8f}, {1.15f, 2.4f}}, 0.34f, 0.16f}};
    return tongues(p, kTongues);
}

}  // namespace espalier::content
