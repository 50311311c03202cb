// Plants whose ground another surface buries: they grow anew around it, and as before when it has moved away.
#include <cstring>

#include "tests/paint/fixture.hpp"

using namespace espalier;
using namespace espalier::test;

namespace {

// A cube of twice `scale` around `at`.
EspTransform placed(glm::vec3 at, float scale = 1) {
    EspTransform place = espIdentity();
    for (int i = 0; i < 3; ++i) place.rows[i][3] = at[i], place.rows[i][i] = scale;
    return place;
}

// How many of the bark's vertices lie in the box.
size_t barkWithin(const Painting& painting, glm::vec3 low, glm::vec3 high) {
    EspTriangles triangles{};
    painting.ok(espMaterialise(painting.context, &triangles));
    size_t within = 0;
    for (uint64_t i = 0; i < triangles.vertexCount; ++i) {
        glm::vec3 p(0);
        std::memcpy(&p, static_cast<const char*>(triangles.vertices) + 16 * i, sizeof p);
        within += glm::all(glm::greaterThan(p, low)) && glm::all(glm::lessThan(p, high));
    }
    return within;
}

}  // namespace

TEST_CASE("a plant whose way is buried grows around what buries it, and as before when that has moved away") {
    Painting painting;
    const EspGrammar grammar = painting.grammar(kMaskedIvy);
    const EspTransform away = placed({10, 0, 0}), over = placed({1.5f, 1.2f, 0});
    const glm::vec3 low(.5f, .2f, -1), high(1.6f, 1, 1);  // of the first cube, the second one's inside
    EspSurface second{};
    painting.ok(espLoadSurface(painting.context, painting.path.c_str(), &away, &second));
    painting.plant(grammar, kFoot, kUp);
    const EspStats before = painting.grown();
    REQUIRE(barkWithin(painting, low, high) > 100);

    painting.ok(espMoveSurface(painting.context, second, &over));
    const EspStats around = painting.grown();
    CHECK(around.contacts > 0);
    CHECK(around.hash != before.hash);
    CHECK(around.nodes > before.nodes / 2);
    CHECK(barkWithin(painting, low + .05f, high - .05f) == 0);

    painting.ok(espMoveSurface(painting.context, second, &away));
    const EspStats after = painting.grown();
    CHECK(after.hash == before.hash);
    CHECK(after.nodes == before.nodes);
    CHECK(barkWithin(painting, low, high) > 100);
}

TEST_CASE(
    "what is planted on bare ground stands on the ground beside it, and nothing grows on the bare; the brush paints "
    "it") {
    Model model = cube(8);
    const float half = .5f;
    makeBare(model, {-half, -half, .9f}, {half, half, 2});
    Painting painting(model, 256);
    const EspGrammar grammar = painting.grammar(kMaskedIvy);
    const auto depth = [&](const float p[3]) {
        return p[2] < .9f ? -1 : half - std::max(std::abs(p[0]), std::abs(p[1]));
    };
    for (uint32_t i = 0; i < 24; ++i) {
        const float angle = float(i) * .8f, far = .02f * float(i);
        const EspSeed seed =
            painting.plant(grammar, {far * std::cos(angle), far * std::sin(angle), 1}, {std::sin(angle), 1, 0}, i + 1);
        EspSeedInfo info{};
        painting.ok(espSeedInfo(painting.context, seed, &info));
        CHECK(depth(info.position) < 0);
        CHECK(depth(info.position) > -.15f);
    }
    CHECK(painting.grown().nodes > 500);
    EspTriangles triangles{};
    painting.ok(espMaterialise(painting.context, &triangles));
    float deepest = -1;
    for (uint64_t i = 0; i < triangles.vertexCount; ++i) {
        float p[3];
        std::memcpy(p, static_cast<const char*>(triangles.vertices) + 16 * i, sizeof p);
        deepest = std::max(deepest, depth(p));
    }
    CHECK(deepest > 0);
    CHECK(deepest < .03f);  // bark is as thick
    EspBrush brush = brushOn("mask", .3f);
    brush.value = .25f;
    painting.stroke(brush, {{{0, 0, 1}, {0, 0, 1}, 1}});
    const std::vector<float> mask = painting.layer("mask");
    float least = 1;
    for (uint32_t y = 0; y < painting.size(); ++y)
        for (uint32_t x = 0; x < painting.size(); ++x) {
            const glm::vec3 p = painting.texel(x, y).position;
            if (glm::length(p - glm::vec3(0, 0, 1)) < .05f) least = std::min(least, mask[y * painting.size() + x]);
        }
    CHECK(least == doctest::Approx(.25f).epsilon(.1));
}

TEST_CASE("what is planted on a bare pane doesn't stand on the wall behind it") {
    Model model = cube(8);
    addPatch(
        model, 1, [](float s, float t) { return glm::vec3(s - .5f, t - .5f, 1.1f); },
        [](float, float) { return glm::vec2(0); });
    makeBare(model, {-2, -2, 1.05f}, {2, 2, 2});
    Painting painting(model, 256);
    const EspGrammar grammar = painting.grammar(kMaskedIvy);
    for (uint32_t i = 0; i < 24; ++i) {
        const float angle = float(i) * .8f, far = .02f * float(i);
        const EspSeed seed =
            painting.plant(grammar, {far * std::cos(angle), far * std::sin(angle), 1.1f}, {0, 1, 0}, i + 1);
        EspSeedInfo info{};
        painting.ok(espSeedInfo(painting.context, seed, &info));
        CHECK(info.position[2] == doctest::Approx(1));
        CHECK(std::max(std::abs(info.position[0]), std::abs(info.position[1])) > .5f);
    }
}

TEST_CASE("a plant that another surface swallows whole, without a contact, is gone until that has moved away") {
    Painting painting;
    const EspGrammar grammar = painting.grammar(kMaskedIvy);
    const EspTransform away = placed({10, 0, 0}), around = placed({.1f, .2f, 0}, 2);
    EspSurface second{};
    painting.ok(espLoadSurface(painting.context, painting.path.c_str(), &away, &second));
    const EspSeed seed = painting.plant(grammar, kFoot, kUp);
    const auto end = [&] {
        EspPlantInfo info{};
        painting.ok(espPlantInfo(painting.context, seed, &info));
        return info.end;
    };
    CHECK(end() == ESP_END_BY_LIMIT);  // it hasn't grown yet
    const EspStats before = painting.grown();
    REQUIRE(before.nodes > 0);
    for (int times = 0; times < 2; ++times) {
        painting.ok(espMoveSurface(painting.context, second, &around));
        const EspStats swallowed = painting.grown();
        CHECK(swallowed.contacts == 0);
        CHECK(swallowed.nodes == 0);
        CHECK(end() == ESP_END_NO_GROUND);
        painting.ok(espMoveSurface(painting.context, second, &away));
        CHECK(painting.grown().hash == before.hash);
        CHECK(end() == ESP_END_BY_RULES);
    }
}
