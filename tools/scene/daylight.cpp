// Hour -> light. Colours of a clear day by the sun's height, blended between a few looks that were chosen by eye.
#include "tools/scene/daylight.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>

namespace espalier::scene {
namespace {

struct Light {
    float height;  // sine of the sun's height
    float sun[3], sky[3], ground[3], background[3], horizon[3];
};

constexpr Light kLights[] = {
    {-.25f, {.48f, .57f, .74f}, {.17f, .21f, .30f}, {.07f, .08f, .09f}, {.012f, .021f, .052f}, {.042f, .060f, .108f}},
    {-.05f, {.14f, .13f, .20f}, {.50f, .53f, .68f}, {.27f, .24f, .21f}, {.07f, .12f, .28f}, {.60f, .36f, .24f}},
    {.08f, {2.8f, 1.42f, .62f}, {.66f, .70f, .84f}, {.40f, .32f, .23f}, {.20f, .32f, .58f}, {.96f, .66f, .42f}},
    {.35f, {2.9f, 2.3f, 1.65f}, {.62f, .72f, .90f}, {.37f, .32f, .24f}, {.30f, .44f, .66f}, {.80f, .78f, .74f}},
    {1.f, {3.0f, 2.75f, 2.35f}, {.66f, .78f, .97f}, {.39f, .34f, .26f}, {.30f, .47f, .72f}, {.74f, .80f, .86f}},
};

}  // namespace

void applyDaylight(float hour, EspLook& look) {
    constexpr float kLatitude = .95f;  // radians off the zenith that noon's sun keeps
    const float angle = (hour - 12) / 12 * std::numbers::pi_v<float>;
    const float up = std::cos(angle) * std::sin(kLatitude), south = std::cos(angle) * std::cos(kLatitude);
    const float direction[3] = {-std::sin(angle), up, south};
    const size_t last = std::size(kLights) - 1;
    size_t i = 0;
    while (i + 1 < last && up > kLights[i + 1].height) ++i;
    const Light &a = kLights[i], &b = kLights[i + 1];
    const float t = std::clamp((up - a.height) / (b.height - a.height), 0.f, 1.f);
    const auto blend = [&](float* to, const float* from, const float* next) {
        for (int c = 0; c < 3; ++c) to[c] = from[c] + t * (next[c] - from[c]);
    };
    blend(look.sunColour, a.sun, b.sun);
    blend(look.skyColour, a.sky, b.sky);
    blend(look.groundColour, a.ground, b.ground);
    blend(look.background, a.background, b.background);
    blend(look.horizon, a.horizon, b.horizon);
    // By night the light comes from the moon, where the sun stood half a day before; it never lights from below.
    const float side = up < -.05f ? -1 : 1;
    for (int c = 0; c < 3; ++c) look.sunDirection[c] = side * direction[c];
    look.sunDirection[1] = std::max(look.sunDirection[1], .04f);
}

}  // namespace espalier::scene
