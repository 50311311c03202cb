// Bare ground: walks end where it begins, whether the border is a seam, runs through a chart, lies near or is a
// contact.
#include <doctest/doctest.h>

#include <cstring>

#include "tests/bake/kits.hpp"
#include "tests/bake/small_models.hpp"

using namespace espalier;
using namespace espalier::test;
using glm::dvec3;

namespace {

Baked bakeKept(const Model& model) {
    BakeOptions options;
    options.resolution = 512;
    options.levels = 3;
    options.keepLayout = true;
    auto baked = bake(model, options);
    if (!baked) FAIL(baked.failure().text());
    return std::move(*baked);
}

struct Walked {
    int walks = 0, open = 0, lost = 0, within = 0, reached = 0;
};

// Walks from ground in all directions on a level; `bare` tells how deep in bare ground a point lies.
template <class Depth>
Walked walkAbout(const SurfaceData& surface, uint32_t onLevel, Depth&& bare) {
    SurfaceRef ref = surfaceRef(surface);
    const SurfaceLevelData& level = surface.levels[0];
    std::mt19937_64 random(5);
    std::uniform_real_distribution<float> unit(0, 1);
    Walked out;
    while (out.walks < 500) {
        const glm::uvec2 at(unit(random) * float(level.size), unit(random) * float(level.size));
        const Texel& t = level.texels[texelIndex(level.size, at.x, at.y)];
        if (texelClass(t.bits) != kTexelInner) continue;
        CHECK(bare(t.position) <= 0);
        WalkState w{};
        const glm::vec3 towards(unit(random) - 0.5f, unit(random) - 0.5f, unit(random) - 0.5f);
        REQUIRE(startWalk({&ref}, onLevel, texelChart(t.bits), (glm::vec2(at) + 0.5f) / float(level.size), towards, w));
        ++out.walks;
        uint32_t event = kWalkDone;
        bool within = false;
        for (int step = 0; step < 150 && event == kWalkDone; ++step) {
            event = walkStep({&ref}, onLevel, w, 0.04f);
            within = within || bare(w.position) > 2e-3f;
        }
        out.within += within;
        out.lost += event == kWalkLost;
        out.open += event == kWalkOpen;
        out.reached += event == kWalkOpen && bare(w.position) > -2e-3f;
    }
    return out;
}

// Depth of a point in a box.
auto depthIn(glm::vec3 low, glm::vec3 high) {
    return [=](glm::vec3 p) {
        const glm::vec3 d = glm::min(p - low, high - p);
        return std::min({d.x, d.y, d.z});
    };
}

}  // namespace

TEST_CASE("walks end at bare ground in the middle of a chart, on every level, and the atlas is as without") {
    Model model = openQuad(8);
    const Baked whole = bakeKept(model);
    const glm::vec3 low(0.25f, 0.375f, -1), high(0.75f, 0.625f, 1);
    makeBare(model, low, high);
    const Baked baked = bakeKept(model);
    CHECK(baked.surface.charts.size() == whole.surface.charts.size());
    REQUIRE(baked.surface.triangles.size() == whole.surface.triangles.size());
    CHECK(std::memcmp(baked.surface.triangles.data(), whole.surface.triangles.data(),
                      whole.surface.triangles.size() * sizeof(TrianglePlane)) == 0);
    CHECK(baked.report.bareTexels > 0);
    CHECK(baked.report.walkableArea == doctest::Approx(1 - 0.125));
    REQUIRE(baked.report.materials.size() == 2);
    CHECK(baked.report.materials[1].bare);
    CHECK(baked.report.materials[1].area == doctest::Approx(0.125));
    CHECK(baked.report.leastReachable() == doctest::Approx(1));
    for (uint32_t level : {0u, 1u, 2u}) {
        CAPTURE(level);
        const Walked walked = walkAbout(baked.surface, level, depthIn(low, high));
        CHECK(walked.within == 0);
        CHECK(walked.lost == 0);
        CHECK(walked.reached > 100);
    }
}

TEST_CASE("a model of bare materials only is refused") {
    Model model = openQuad(2);
    makeBare(model, {-9, -9, -9}, {9, 9, 9});
    const auto baked = bake(model, {});
    REQUIRE(!baked);
    CHECK(baked.failure().text() == "quad: no ground is left: all of its materials are bare");
}

TEST_CASE("walks end at bare ground beyond a seam") {
    Model model = cube(4);
    makeBare(model, {0.99f, -2, -2}, {2, 2, 2});
    const Baked baked = bakeKept(model);
    CHECK(baked.report.walkableArea == doctest::Approx(20));
    CHECK(baked.report.danglingCrossings == 0);
    CHECK(baked.report.leastReachable() == doctest::Approx(1));
    const auto depth = [](glm::vec3 p) {
        return p.x < 0.999f ? p.x - 1 : 1 - std::max(std::abs(p.y), std::abs(p.z)) - 1e-4f;
    };
    const Walked walked = walkAbout(baked.surface, 0, depth);
    CHECK(walked.within == 0);
    CHECK(walked.lost == 0);
    CHECK(walked.reached > 200);
}

TEST_CASE("walks end where a bare piece stands on ground, and go on where one stands that isn't bare") {
    for (bool bare : {true, false}) {
        CAPTURE(bare);
        Kit kit;
        kit.box({0, 0, 0}, {2, 0.5, 2});
        kit.box({0, 0.9, 0}, dvec3(0.5));
        Model model = kit.model();
        makeBare(model, {-0.6f, 0.45f, -0.6f}, {0.6f, 2, 0.6f});
        model.materials[1].bare = bare;
        const Baked baked = bakeKept(model);
        CHECK(baked.report.leastReachable() > 0.995);
        const Walked walked = walkAbout(baked.surface, 0, [&](glm::vec3 p) {
            const float above = p.y - 0.5f, beside = std::max(std::abs(p.x), std::abs(p.z)) - 0.5f;
            return bare ? std::max(above, above > -0.01f ? -beside : above) - 1e-3f : -1.0f;
        });
        CHECK(walked.within == 0);
        CHECK(walked.lost == 0);
        CHECK((bare ? walked.open > 20 : walked.open == 0));
    }
}

TEST_CASE("walks end at a bare pane that only lies near its frame") {
    Kit kit;
    kit.panel({-1, 0, 0}, {1, 0, 0}, {0, 1, 0});
    kit.panel({0.0005, 0, 0}, {1, 0, 0}, {0, 1, 0});
    Model model = kit.model();
    makeBare(model, {0, -1, -1}, {2, 2, 1});
    const Baked baked = bakeKept(model);
    CHECK(baked.report.nearestCrossings == 0);
    const Walked walked = walkAbout(baked.surface, 0, depthIn({0.0005f, 0, -1}, {1, 1, 1}));
    CHECK(walked.within == 0);
    CHECK(walked.lost == 0);
    CHECK(walked.reached > 50);
}
