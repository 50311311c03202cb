// Single steps: events and samples, borders, turns, stored walks, scales, absurd input.
#include <cmath>
#include <limits>

#include <doctest/doctest.h>

#include "tests/walk/judge.hpp"

using namespace espalier;
using namespace espalier::walktest;

namespace {

bool finite(const WalkState& w) {
    auto all = [](vec3 v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); };
    return all(w.position) && all(w.walk.direction) && all(w.normal) && std::isfinite(w.walk.uv.x) &&
           std::isfinite(w.walk.uv.y) && std::isfinite(w.walk.arc) &&
           std::abs(glm::length(w.walk.direction) - 1) < 1e-4f &&
           std::abs(glm::dot(w.walk.direction, w.normal)) < 1e-4f;
}

WalkState started(const SurfaceBuf& surfaces, const SurfaceData& data, const Start& s) {
    WalkState w{};
    vec2 uv(s.uv);
    REQUIRE(startWalk(surfaces, 0, chartAt(data, uv, s.position), uv, vec3(s.direction), w));
    return w;
}

SurfaceData bakedStrip() {
    BakeOptions options;
    options.resolution = 512;
    options.keepLayout = true;
    auto result = bake(toModel(cubeWithStrip()), options);
    REQUIRE(result);
    return std::move(*result).surface;
}

}  // namespace

TEST_CASE("the geometry image from formulas alone gives walks as true as the baker's") {
    for (const Shape& shape : {sphere(96), torus(96), cylinder(96), cone(96), cubeOfSixCharts()}) {
        SurfaceData data = toSurface(shape, 1024, 1);
        auto trials = shapeTrials(shape, data, 200, 3 * shape.radius, 21);
        Drift drift = judge(data, trials, 0, 0.01f * float(shape.radius), Scheme::intrinsic);
        CHECK_MESSAGE(drift.lost == 0, shape.name);
        CHECK_MESSAGE(drift.median <= 0.1, shape.name);
        CHECK_MESSAGE(drift.p95 <= 1, shape.name);
    }
}

TEST_CASE("absurd lengths, headings and places end without a hang and without NaN") {
    Shape shape = sphere(32);
    SurfaceData data = toSurface(shape, 128, 2);
    SurfaceRef ref = surfaceRef(data);
    SurfaceBuf surfaces{&ref};
    std::mt19937_64 random(3);
    const float nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
    for (float length : {0.0f, -1.0f, nan, inf, 1e30f, 1e-30f, 50.0f}) {
        WalkState w = started(surfaces, data, randomStart(shape, random));
        uint event = walkStep(surfaces, 0, w, length);
        CHECK(!walkGoesOn(event));
        CHECK(finite(w));
    }
    for (vec3 direction : {vec3(0), vec3(nan), vec3(inf, 0, 0), vec3(1e-30f), vec3(0, 0, 1)})
        for (vec2 uv : {vec2(0.2f, 0.3f), vec2(-5, 7), vec2(nan, 0.5f), vec2(inf, -inf), vec2(1, 1), vec2(0, 0)})
            for (uint chart = 0; chart < 6; ++chart) {
                WalkState w{};
                if (!startWalk(surfaces, 0, chart, uv, direction, w)) continue;
                for (int i = 0; i < 20; ++i) walkStep(surfaces, 7, w, 0.1f);
                CHECK(finite(w));
            }
}

TEST_CASE("random turns and lengths never lose a walk on a closed surface") {
    Shape shape = sphere(96);
    SurfaceData data = toSurface(shape, 256, 1);
    SurfaceRef ref = surfaceRef(data);
    SurfaceBuf surfaces{&ref};
    std::mt19937_64 random(5);
    std::uniform_real_distribution<float> unit(0, 1);
    int stopped = 0, off = 0;
    for (int i = 0; i < 300; ++i) {
        WalkState w = started(surfaces, data, randomStart(shape, random));
        for (int k = 0; k < 200; ++k) {
            rotateHeading(w, 3 * (unit(random) - 0.5f));
            stopped += walkStep(surfaces, 0, w, 0.06f * unit(random)) != kWalkDone;
            off += !(std::abs(glm::length(w.position) - 1) < 2e-3f) || !finite(w);
        }
    }
    CHECK(stopped == 0);
    CHECK(off == 0);
}

TEST_CASE("a walk stops at a border of the model, with what it did not walk") {
    Shape shape = cylinder(64);
    SurfaceData data = toSurface(shape, 512, 1);
    SurfaceRef ref = surfaceRef(data);
    SurfaceBuf surfaces{&ref};
    std::mt19937_64 random(9);
    for (int i = 0; i < 100; ++i) {
        Start s = randomStart(shape, random);
        s.direction = Vec3(0, 0, i % 2 ? 1 : -1);
        double room = 1.4 - s.position.z * s.direction.z;
        WalkState w = started(surfaces, data, s);
        float remaining = 5;
        vec3 jointNormal;
        uint event = kWalkRetry;
        while (walkGoesOn(event)) event = walkAdvance(surfaces, 0, w, remaining, jointNormal);
        CHECK(event == kWalkOpen);
        CHECK(5 - remaining == doctest::Approx(room).epsilon(0.01));
        CHECK(w.walk.arc == doctest::Approx(room).epsilon(0.01));
        CHECK(std::abs(w.position.z) == doctest::Approx(1.4).epsilon(0.001));
        CHECK(walkStep(surfaces, 0, w, 0.1f) == kWalkOpen);  // and stays there
    }
}

TEST_CASE("steps over edges leave a sample on the edge, its normal between the faces'") {
    SurfaceData data = bakedStrip();
    SurfaceRef ref = surfaceRef(data);
    SurfaceBuf surfaces{&ref};
    Shape shape = cubeWithStrip();
    std::mt19937_64 random(13);
    int seams = 0, creases = 0;
    for (int i = 0; i < 300; ++i) {
        WalkState w = started(surfaces, data, randomStart(shape, random));
        float remaining = 2;
        uint event = kWalkRetry;
        while (walkGoesOn(event)) {
            vec3 jointNormal;
            vec3 before = w.normal;
            event = walkAdvance(surfaces, 0, w, remaining, jointNormal);
            if (event != kWalkSeam && event != kWalkCrease) {
                // No edge is passed unseen, but by walks along it.
                CHECK((dot3(before, w.normal) > 0.999f || std::abs(dot3(w.walk.direction, before)) < 0.02f));
                continue;
            }
            (event == kWalkSeam ? seams : creases) += 1;
            vec3 a = glm::abs(w.position);
            float largest = std::max({a.x, a.y, a.z}), least = std::min({a.x, a.y, a.z});
            float middle = a.x + a.y + a.z - largest - least;
            // Beside a corner the plane of the nearest texel may be the neighbour's: half a texel, 0.0087.
            CHECK(largest == doctest::Approx(1).epsilon(0.005));
            CHECK(middle == doctest::Approx(1).epsilon(0.002));
            CHECK(dot3(before, w.normal) == doctest::Approx(0).epsilon(0.01));
            CHECK(dot3(jointNormal, w.normal) == doctest::Approx(0.7071).epsilon(0.01));
        }
        CHECK(event == kWalkDone);
    }
    CHECK(seams > 100);
    CHECK(creases > 50);
}

TEST_CASE("turns, headings and stored walks agree with one another") {
    Shape shape = torus(96);
    SurfaceData data = toSurface(shape, 512, 1);
    SurfaceRef ref = surfaceRef(data);
    SurfaceBuf surfaces{&ref};
    std::mt19937_64 random(17);
    for (int i = 0; i < 200; ++i) {
        Start s = randomStart(shape, random);
        WalkState w = started(surfaces, data, s);
        CHECK(dot3(w.normal, vec3(shape.normal(s.position))) > 0.99f);  // mirrored charts too
        CHECK(std::abs(headingTo(w, vec3(s.direction))) < 0.03f);
        float angle = 0.031f * float(i - 100);
        WalkState turned = w;
        rotateHeading(turned, angle);
        CHECK(headingTo(w, turned.walk.direction) == doctest::Approx(angle).epsilon(0.001));
        CHECK(dot3(cross3(w.walk.direction, turned.walk.direction), w.normal) * angle >= 0);

        WalkState again{}, once{};
        REQUIRE(resumeWalk(surfaces, 0, w.walk, again));
        REQUIRE(resumeWalk(surfaces, 0, again.walk, once));
        walkStep(surfaces, 0, again, 0.3f);
        walkStep(surfaces, 0, once, 0.3f);
        CHECK(glm::length(again.position - once.position) < 1e-5f);
    }
}

TEST_CASE("lengths are metres of the world") {
    Shape shape = sphere(96);
    SurfaceData data = toSurface(shape, 512, 1);
    SurfaceRef one = surfaceRef(data), three = surfaceRef(data, 3);
    std::mt19937_64 random(19);
    for (int i = 0; i < 50; ++i) {
        Start s = randomStart(shape, random);
        WalkState a = started(SurfaceBuf{&one}, data, s), b = a;
        CHECK(walkStep(SurfaceBuf{&one}, 0, a, 0.5f) == kWalkDone);
        CHECK(walkStep(SurfaceBuf{&three}, 0, b, 1.5f) == kWalkDone);
        CHECK(glm::length(a.position - b.position) < 1e-4f);
        CHECK(a.walk.arc == doctest::Approx(0.5f).epsilon(1e-4));
        CHECK(b.walk.arc == doctest::Approx(1.5f).epsilon(1e-4));
    }
}

TEST_CASE("the paper's walk jumps by its links and stops at borders") {
    Shape shape = cubeOfSixCharts(false);
    SurfaceData data = toSurface(shape, 512, 1);
    SurfaceRef ref = surfaceRef(data);
    SurfaceBuf surfaces{&ref};
    std::mt19937_64 random(23);
    int jumps = 0;
    for (int i = 0; i < 100; ++i) {
        Start s = randomStart(shape, random);
        WalkState w{};
        REQUIRE(startPaperWalk(surfaces, 0, uint(s.chart), vec2(s.uv), vec3(s.direction), w));
        CHECK(dot3(paperHeading3(w), vec3(s.direction)) > 0.999f);
        for (int k = 0; k < 200; ++k) {
            uint before = w.walk.place;
            CHECK(paperStep(surfaces, 0, w, 0.02f) == kWalkDone);
            jumps += w.walk.place != before;
        }
        vec3 a = glm::abs(w.position);
        CHECK(std::max({a.x, a.y, a.z}) == doctest::Approx(1).epsilon(0.01));
    }
    CHECK(jumps > 100);
}
