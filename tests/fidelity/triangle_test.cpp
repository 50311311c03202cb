// The triangle under a texture coordinate (triangle_lookup.h), against the triangle in which that was drawn.
#include <doctest/doctest.h>

#include <cmath>

#include "shaders/shared/random.h"
#include "shaders/shared/triangle_lookup.h"
#include "tests/support/cube_model.hpp"
#include "tools/bake/bake.hpp"

using namespace espalier;

TEST_CASE("places are found on their triangle") {
    for (const Model& model : {test::cube(), test::ball(48)}) {
        Result<Baked> baked = bake(model, BakeOptions{});
        REQUIRE(baked);
        const SurfaceData& data = baked->surface;
        SurfaceRef ref = surfaceRef(data);
        const SurfaceBuf surfaces{&ref};
        uint32_t asked = 0, wrong = 0, unsure = 0;
        for (uint32_t i = 0; i < 20'000; ++i) {
            const TrianglePlane& t = data.triangles[size_t(uniformRandom(i, 1) * double(data.triangles.size()))];
            float a = uniformRandom(i, 2), b = uniformRandom(i, 3);
            if (a + b > 1) a = 1 - a, b = 1 - b;
            const glm::vec2 uv = t.uv0 + (t.uv1 - t.uv0) * a + (t.uv2 - t.uv0) * b;
            TrianglePlane found;
            const uint32_t at = triangleUnder(surfaces, t.chart, uv, found);
            asked += 1;
            unsure += at == kNoIndex;
            if (at == kNoIndex) continue;
            // Another one on whose edge it lies is as good.
            const float texel = data.charts[t.chart].metresPerUv / float(data.levels[0].size);
            wrong += !(glm::length(pointOn(found, uv) - pointOn(t, uv)) < 0.02f * texel);
        }
        CHECK(unsure == 0);
        CHECK(wrong <= asked / 1000);
    }
}

TEST_CASE("a path leaves a triangle by the edge ahead") {
    TrianglePlane t{};
    t.uv0 = {0, 0};
    for (bool mirrored : {false, true}) {
        t.uv1 = mirrored ? glm::vec2(0, 1) : glm::vec2(1, 0);
        t.uv2 = mirrored ? glm::vec2(1, 0) : glm::vec2(0, 1);
        CHECK(shareInside(t, {.25f, .25f}, {1, 0}) == doctest::Approx(.5));
        CHECK(shareInside(t, {.25f, .25f}, {-1, 0}) == doctest::Approx(.25));
        CHECK(shareInside(t, {.25f, .25f}, {.1f, .1f}) == doctest::Approx(2));  // not on the way
        CHECK(shareInside(t, {0, .25f}, {.5f, 0}) == doctest::Approx(1.5));     // from an edge inwards
        CHECK(outsideOf(t, {.2f, .3f}) == 0);
        CHECK(outsideOf(t, {1, 1}) == doctest::Approx(.5));
        CHECK(outsideOf(t, {-.3f, -.4f}) == doctest::Approx(.25));  // from a corner
    }
}

TEST_CASE("beside a triangle its nearest point stands for a place, not its plane") {
    TrianglePlane t{};
    t.uv0 = {0, 0};
    t.uv1 = {1, 0};
    t.uv2 = {0, 1};
    t.position = {5, 0, 0};
    t.du = {1, 0, 2};  // it rises by 2 along u
    t.dv = {0, 1, 0};
    CHECK(glm::length(pointOn(t, {.25f, .5f}) - vec3(5.25f, .5f, .5f)) < 1e-6f);
    CHECK(glm::length(pointOn(t, {-1, .5f}) - vec3(5, .5f, 0)) < 1e-6f);  // beside an edge
    CHECK(glm::length(pointOn(t, {1, 1}) - vec3(5.5f, .5f, 1)) < 1e-6f);  // beside the long one
    CHECK(glm::length(pointOn(t, {3, -1}) - vec3(6, 0, 2)) < 1e-6f);      // beside a corner
}
