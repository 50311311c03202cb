#include <doctest/doctest.h>

#include <cmath>
#include <limits>

#include "runtime/plugin/layer_resample.hpp"

using namespace espalier;

namespace {

constexpr uint32_t kSize = 64;

// Two square charts of the walk: the left one is drawn in the materials' UV upright, the right one turned by a
// quarter and over the same square, as tiling materials do.
SurfaceData twoCharts() {
    SurfaceData data;
    data.levels.resize(1);
    SurfaceLevelData& level = data.levels[0];
    level.size = kSize;
    level.texels.assign(kSize * kSize, Texel{});
    const auto addChart = [&](uint32_t chart, glm::vec2 low, glm::vec2 high, bool turned) {
        const uint32_t first = uint32_t(data.vertices.size());
        for (const glm::vec2 corner : {glm::vec2(0, 0), glm::vec2(1, 0), glm::vec2(1, 1), glm::vec2(0, 1)}) {
            DrawVertex vertex{};
            vertex.walkUv = low + corner * (high - low);
            vertex.uv = turned ? glm::vec2(corner.y, 1 - corner.x) : corner;
            data.vertices.push_back(vertex);
        }
        for (uint32_t i : {0, 1, 2, 0, 2, 3}) data.indices.push_back(first + i);
        for (uint32_t y = 0; y < kSize; ++y)
            for (uint32_t x = 0; x < kSize; ++x) {
                const glm::vec2 uv = (glm::vec2(x, y) + .5f) / float(kSize);
                const glm::vec2 out = glm::max(low - uv, uv - high) * float(kSize);
                const float distance = std::max(out.x, out.y);
                if (distance > 3) continue;
                level.texels[texelIndex(kSize, x, y)].bits =
                    packTexelBits(chart, distance <= 0 ? kTexelInner : kTexelLink, 0, 0, 0);
            }
    };
    addChart(0, {.1f, .1f}, {.45f, .45f}, false);
    addChart(1, {.55f, .1f}, {.9f, .45f}, true);
    return data;
}

float at(const std::vector<float>& layer, glm::vec2 uv) {
    return layer[texelIndex(kSize, uint32_t(uv.x * kSize), uint32_t(uv.y * kSize))];
}

}  // namespace

TEST_CASE("a picture in the materials' UV comes to lie where the model shows it") {
    const SurfaceData data = twoCharts();
    // A ramp: u of the material's UV.
    std::vector<float> texels(32 * 32);
    for (int y = 0; y < 32; ++y)
        for (int x = 0; x < 32; ++x) texels[size_t(y * 32 + x)] = (float(x) + .5f) / 32;
    const auto layer = resampleLayer(data, {texels, 32, 32, true});
    REQUIRE(layer.size() == kSize * kSize);
    for (float s : {.15f, .5f, .85f})
        for (float t : {.15f, .5f, .85f}) {
            CHECK(at(layer, glm::vec2(.1f) + .35f * glm::vec2(s, t)) == doctest::Approx(s).epsilon(.06));
            CHECK(at(layer, glm::vec2(.55f, .1f) + .35f * glm::vec2(s, t)) == doctest::Approx(t).epsilon(.06));
        }
}

TEST_CASE("the gutter of a chart goes on from its own border") {
    const SurfaceData data = twoCharts();
    std::vector<float> texels(16 * 16, 0.f);
    for (int y = 0; y < 16; ++y)
        for (int x = 8; x < 16; ++x) texels[size_t(y * 16 + x)] = 1;  // right half white
    const auto layer = resampleLayer(data, {texels, 16, 16, true});
    CHECK(at(layer, {.45f + 2.f / kSize, .3f}) == 1);  // right of the left chart, whose right half is white
    CHECK(at(layer, {.1f - 2.f / kSize, .3f}) == 0);
}

TEST_CASE("a picture in the walk's UV is read where it is drawn") {
    const SurfaceData data = twoCharts();
    std::vector<float> texels(64 * 64);
    for (int y = 0; y < 64; ++y)
        for (int x = 0; x < 64; ++x) texels[size_t(y * 64 + x)] = float(y) / 63;
    const auto layer = resampleLayer(data, {texels, 64, 64, false});
    CHECK(at(layer, {.3f, .2f}) == doctest::Approx(.2f).epsilon(.1));
    CHECK(at(layer, {.7f, .4f}) == doctest::Approx(.4f).epsilon(.1));
}

TEST_CASE("pictures of one texel, and values that aren't numbers, do no harm") {
    const SurfaceData data = twoCharts();
    const float nan = std::numeric_limits<float>::quiet_NaN();
    for (const bool material : {false, true})
        for (const float value : {nan, -1.f, 2.f, .5f}) {
            const std::vector<float> one{value};
            const auto layer = resampleLayer(data, {one, 1, 1, material});
            const float expected = value > 0 ? std::min(value, 1.f) : 0;
            CHECK(at(layer, {.3f, .3f}) == expected);
            CHECK(at(layer, {.7f, .3f}) == expected);
        }
}

TEST_CASE("a picture much finer than the walk is averaged, not picked from") {
    const SurfaceData data = twoCharts();
    std::vector<float> texels(1024 * 1024);
    for (size_t i = 0; i < texels.size(); ++i) texels[i] = float((i ^ (i / 1024)) & 1);  // a fine chess board
    const auto layer = resampleLayer(data, {texels, 1024, 1024, true});
    for (float s : {.2f, .5f, .8f})
        CHECK(at(layer, glm::vec2(.1f + .35f * s, .3f)) == doctest::Approx(.5f).epsilon(.1));
}
