// Which side is out: patches that face the wrong way, strips that have no sides, edges of many triangles.
#include <doctest/doctest.h>

#include "tests/bake/kits.hpp"
#include "tests/bake/small_models.hpp"

using namespace espalier;
using namespace espalier::test;
using glm::dvec3;

namespace {

std::string warningsOf(const Baked& baked) {
    std::string all;
    for (const Diagnostic& d : baked.report.warnings) all += d.message + "\n";
    return all;
}

// The share of inner texels whose outward normal, by triangle and chart, points away from the middle.
double outwardShare(const SurfaceData& data) {
    double out = 0, all = 0;
    for (size_t i = 0; i < data.levels[0].texels.size(); ++i) {
        const Texel& t = data.levels[0].texels[i];
        if (texelClass(t.bits) != kTexelInner) continue;
        const TrianglePlane& plane = data.triangles[data.levels[0].aux[i].triangle];
        glm::vec3 n = glm::cross(plane.du, plane.dv) * data.charts[plane.chart].orientation;
        out += glm::dot(n, t.position) > 0;
        all += 1;
    }
    return out / all;
}

}  // namespace

TEST_CASE("faces of a box that point inward are turned, and walks go around it") {
    Kit kit;
    kit.box({0, 0, 0}, dvec3(1));
    for (const std::vector<int>& flipped : {std::vector<int>{2}, {0, 3}, {1, 2, 4, 5}, {0, 1, 2, 3, 4, 5}}) {
        Baked baked = kit.bake(256, flipped);
        CHECK(outwardShare(baked.surface) == 1);
        CHECK(warningsOf(baked).find("turned") != std::string::npos);
        CHECK(warningsOf(baked).find("opposite ways") == std::string::npos);
        for (const Crossing& c : baked.surface.crossings) CHECK((c.flags & 3u) == kCrossingSeam);
        Stroll walk(baked.surface);
        REQUIRE(walk.start(kit, 0, 0.5, 0.5, {0, 1, 0}));
        CHECK(walk.go(8) == kWalkDone);
        CHECK(glm::length(walk.w.position - glm::vec3(1, 0, 0)) < 1e-3f);
    }
    CHECK(warningsOf(kit.bake(256)).find("turned") == std::string::npos);
}

TEST_CASE("a model's normals say which side is out, as of a room seen from inside") {
    Model room = cube(2);
    room.normals.clear();
    for (size_t t = 0; t < room.indices.size(); t += 3) std::swap(room.indices[t], room.indices[t + 1]);
    for (glm::vec3 p : room.positions) room.normals.push_back(glm::normalize(-p));
    BakeOptions options;
    options.resolution = 128;
    options.keepLayout = true;
    auto inward = bake(room, options);
    REQUIRE(inward);
    CHECK(outwardShare(inward->surface) == 0);
    room.normals.clear();
    auto outward = bake(room, options);
    REQUIRE(outward);
    CHECK(outwardShare(outward->surface) == 1);
}

TEST_CASE("a Moebius strip is baked, and named; where its sides meet a walk goes over to the back") {
    Model strip;
    strip.name = "strip";
    addPatch(
        strip, 24,
        [](float s, float t) {
            // The last column is the first one, upside down.
            float u = s >= 1 ? 0.0f : s * 6.2831853f, w = (s >= 1 ? 0.5f - t : t - 0.5f) * 0.8f, half = u / 2;
            return glm::vec3((1 + w * std::cos(half)) * std::cos(u), (1 + w * std::cos(half)) * std::sin(u),
                             w * std::sin(half));
        },
        [](float s, float t) { return glm::vec2(0.05f + s * 0.9f, 0.2f + t * 0.2f); });
    BakeOptions options;
    options.resolution = 256;
    options.keepLayout = true;
    auto baked = bake(strip, options);
    REQUIRE(baked);
    CHECK(warningsOf(*baked).find("Möbius") != std::string::npos);
    const SurfaceRef ref = surfaceRef(baked->surface);
    const SurfaceBuf surfaces{const_cast<SurfaceRef*>(&ref)};
    // There the strip lies flat, and walks go straight.
    for (float sign : {1.0f, -1.0f}) {
        WalkState w{};
        const float u = sign * -0.2f, s = u > 0 ? u : 6.2831853f + u;
        const glm::vec3 start(std::cos(u), std::sin(u), 0), along = glm::vec3(-std::sin(u), std::cos(u), 0) * sign;
        REQUIRE(startWalk(surfaces, 0, 0, {0.05f + s / 6.2831853f * 0.9f, 0.3f}, along, w));
        CHECK(walkStep(surfaces, 0, w, 0.5f) == kWalkDone);
        CHECK(glm::length(w.position - (start + along * 0.5f)) < 0.03f);
    }
}

TEST_CASE("at an edge of four faces walks go on along the outside") {
    // Two boxes that share one edge, diagonally: (0, y, 0).
    Kit kit;
    int first = kit.box({0.5, 0, 0.5}, dvec3(0.5));
    int second = kit.box({-0.5, 0, -0.5}, dvec3(0.5));
    Baked baked = kit.bake(512);
    Stroll walk(baked.surface);
    // From the first's -x side to the second's +z side and back.
    REQUIRE(walk.start(kit, first + 1, 0.5, 0.5, {0, 0, -1}));
    CHECK(walk.go(1) == kWalkDone);
    CHECK(glm::length(walk.w.position - glm::vec3(-0.5f, 0, 0)) < 1e-3f);
    REQUIRE(walk.start(kit, second, 0.5, 0.5, {0, 0, 1}));
    CHECK(walk.go(1) == kWalkDone);
    CHECK(glm::length(walk.w.position - glm::vec3(0.5f, 0, 0)) < 1e-3f);
}
