// Faces that lie against each other and look opposite ways: floors within towers that have no inside, inner skins of
// walls. Nothing is turned that its normals say is right, and nobody walks where nobody sees.
#include <doctest/doctest.h>

#include "tests/bake/gltf_maker.hpp"
#include "tests/bake/kits.hpp"
#include "tests/support/data.hpp"

using namespace espalier;
using namespace espalier::test;
using glm::dvec3;

namespace {

// The kit with its panels' own normals.
Model withNormals(const Kit& kit) {
    Model model = kit.model();
    for (int i = 0; i < kit.count(); ++i) model.normals.insert(model.normals.end(), 4, glm::vec3(kit[i].normal()));
    return model;
}

Baked bakeKit(const Kit& kit) {
    return bakeOrFail(withNormals(kit), 512, true);
}

// Walls around [-1,1]² from 0 to 2, that look outward; lid: a roof.
int addWalls(Kit& kit, bool lid) {
    const int first = kit.panel({-1, 0, 1}, {2, 0, 0}, {0, 2, 0});
    kit.panel({1, 0, 1}, {0, 0, -2}, {0, 2, 0});
    kit.panel({1, 0, -1}, {-2, 0, 0}, {0, 2, 0});
    kit.panel({-1, 0, -1}, {0, 0, 2}, {0, 2, 0});
    if (lid) kit.panel({-1, 2, 1}, {2, 0, 0}, {0, 0, -2});
    return first;
}

}  // namespace

TEST_CASE("a floor that looks up within walls that look out isn't turned, nor are they") {
    for (bool lid : {false, true}) {
        CAPTURE(lid);
        Kit kit;
        const int wall = addWalls(kit, lid);
        kit.panel({-1, 0, 1}, {2, 0, 0}, {0, 0, -2});
        const Baked baked = bakeKit(kit);
        CHECK(!says(warningsOf(baked.report.warnings), "turned"));
        CHECK(says(warningsOf(baked.report.warnings), "opposite ways"));
        // A walk that comes down goes over to the floor's back.
        Stroll stroll(baked.surface);
        REQUIRE(stroll.start(kit, wall, 0.5, 0.2, {0, -1, 0}));
        CHECK(stroll.go(0.8) == kWalkDone);
        CHECK(glm::length(dvec3(stroll.w.position) - dvec3(0, 0, 0.6)) < 1e-2);
    }
}

TEST_CASE("a hull's bottom that misses its walls by a hair comes before the floor within") {
    for (double hair : {-1e-3, 1e-3}) {
        CAPTURE(hair);
        Kit kit;
        const int wall = addWalls(kit, true);
        const int floor = kit.panel({-1, 0, 1}, {2, 0, 0}, {0, 0, -2});
        const double half = 1 + hair;
        const int bottom = kit.panel({-half, 0, -half}, {2 * half, 0, 0}, {0, 0, 2 * half});
        const Baked baked = bakeKit(kit);
        CHECK(!says(warningsOf(baked.report.warnings), "turned"));
        CHECK(baked.report.leastReachable() > 0.99);
        // Five sides of 4 m², and the bottom; the floor is within.
        CHECK(groundOf(baked.report) == doctest::Approx(24).epsilon(0.02));
        Stroll stroll(baked.surface);
        REQUIRE(stroll.start(kit, wall, 0.5, 0.2, {0, -1, 0}));
        CHECK(stroll.go(2) == kWalkDone);
        CHECK(glm::length(dvec3(stroll.w.position) - dvec3(0, 0, -0.6)) < 1e-2);
        const SurfaceLevelData& level = baked.surface.levels[0];
        const auto classAt = [&](int panel) {
            return texelClass(level.texels[texelAt(level.size, glm::vec2(kit.uv(panel, 0.4, 0.4)))].bits);
        };
        CHECK(classAt(floor) == kTexelLink);
        CHECK(classAt(bottom) == kTexelInner);
    }
}

TEST_CASE("an inner skin that lies against a wall from behind takes nothing of it away") {
    for (double above : {-2e-3, 0.0, 2e-3})
        for (double half : {0.4, 1.0}) {
            CAPTURE(above);
            CAPTURE(half);
            Kit kit;
            const int box = kit.box({0, 0, 0}, dvec3(1));
            // It looks into the box, whose face +x looks out.
            kit.panel({1 + above, -half, -half}, {0, 0, 2 * half}, {0, 2 * half, 0});
            const Baked baked = bakeKit(kit);
            CHECK(!says(warningsOf(baked.report.warnings), "turned"));
            CHECK(groundOf(baked.report) == doctest::Approx(24).epsilon(0.01));
            CHECK(baked.report.reachableShare() > 0.995);
            // Across the face, over the skin and its borders, and around.
            Stroll stroll(baked.surface);
            REQUIRE(stroll.start(kit, box, 0.5, 0.05, {0, 0.98, 0.2}));
            CHECK(stroll.go(7) == kWalkDone);
        }
}

TEST_CASE("of a tower whose parts lie against each other nothing is turned, and walks go on") {
    auto path = dataFile("reports/tower.gltf");
    if (!path) return;
    auto model = importModel(*path);
    REQUIRE(model);
    const Baked baked = bakeOrFail(*model, 1024);
    CAPTURE(warningsOf(baked.report.warnings));
    CHECK(!says(warningsOf(baked.report.warnings), "turned"));
    CHECK(baked.report.leastReachable() > 0.99);
    // The drawn triangles, too, are as the file has them.
    size_t against = 0;
    const SurfaceData& surface = baked.surface;
    for (size_t i = 0; i < surface.indices.size(); i += 3) {
        const DrawVertex *a = &surface.vertices[surface.indices[i]], *b = &surface.vertices[surface.indices[i + 1]],
                         *c = &surface.vertices[surface.indices[i + 2]];
        against += glm::dot(glm::cross(b->position - a->position, c->position - a->position),
                            a->normal + b->normal + c->normal) < 0;
    }
    CHECK(against == 0);
}
