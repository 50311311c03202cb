// When shadows are drawn anew, and how much of them: the rules alone, without a device.
#include "runtime/render/shadow_state.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <random>

#include "runtime/render/frame.hpp"
#include "runtime/render/targets.hpp"

using namespace espalier;
using Redraw = NearShadows::Redraw;

namespace {

constexpr ShadowWish kSettled{}, kPainting{.mayLag = true};

ShadowScene scene(uint64_t growth) {
    return {.growth = growth, .stands = 1, .roofs = 1, .sun = {0, 1, 0}, .sphere = {0, 0, 0, 5}};
}

// A map that was drawn whole for scene(1), with tiles by which edits of growth are redrawn.
NearShadows kept() {
    NearShadows near;
    CHECK(near.begin(scene(1), kSettled));
    CHECK(near.redraw(true, 1) == Redraw::whole);
    near.drewWhole(true, 1);
    return near;
}

}  // namespace

TEST_CASE("what shows the same is drawn once") {
    NearShadows near = kept();
    for (int i = 0; i < 3; ++i) {
        CHECK(!near.begin(scene(1), kSettled));
        CHECK(!near.behind());
    }
    CHECK(near.timesWhole() == 1);
    ShadowScene turned = scene(1);
    turned.sun = {1, 0, 0};
    CHECK(near.begin(turned, kSettled));
    CHECK(near.redraw(true, 1) == Redraw::whole);
}

TEST_CASE("an edit of growth redraws its tiles, unless growth was bound whole since or something else has changed") {
    NearShadows near = kept();
    CHECK(near.begin(scene(2), kSettled));
    CHECK(near.redraw(true, 1) == Redraw::allTiles);
    CHECK(near.redraw(true, 2) == Redraw::whole);
    CHECK(near.redraw(false, 1) == Redraw::whole);
    near.drewAllTiles();
    CHECK(!near.begin(scene(2), kSettled));
    ShadowScene moved = scene(3);
    moved.stands = 2;
    CHECK(near.begin(moved, kSettled));
    CHECK(near.redraw(true, 1) == Redraw::whole);
}

TEST_CASE(
    "in a stroke every second picture redraws a few tiles, says that it is behind, and all follows when growth rests") {
    NearShadows near = kept();
    uint32_t few = 0, none = 0;
    for (uint64_t growth = 2; growth < 20; ++growth) {
        REQUIRE(near.begin(scene(growth), kPainting));
        const Redraw redraw = near.redraw(true, 1);
        if (growth < 3) {  // no stroke yet
            CHECK(redraw == Redraw::allTiles);
            near.drewAllTiles();
            continue;
        }
        CHECK(near.behind());
        REQUIRE((redraw == Redraw::fewTiles || redraw == Redraw::nothing));
        (redraw == Redraw::fewTiles ? few : none) += 1;
        if (redraw == Redraw::fewTiles) near.drewFewTiles();
    }
    CHECK(few == 8);
    CHECK(none == 9);
    CHECK(near.begin(scene(19), kPainting));
    CHECK(near.redraw(true, 1) == Redraw::allTiles);
    near.drewAllTiles();
    CHECK(!near.behind());
    CHECK(!near.begin(scene(19), kPainting));
}

TEST_CASE("a coarse map will do while something moves, and no longer") {
    const ShadowWish moving{.mayLag = true, .quick = true};
    NearShadows near;
    CHECK(near.begin(scene(1), moving));
    CHECK(near.coarse());
    near.drewWhole(false, 1);
    CHECK(near.behind());
    CHECK(!near.begin(scene(1), moving));
    CHECK(near.behind());
    CHECK(near.begin(scene(1), kSettled));
    CHECK(!near.coarse());
    near.drewWhole(true, 1);
    CHECK(!near.behind());
}

TEST_CASE("where a redraw failed, all is drawn anew") {
    NearShadows near = kept();
    near.clear();  // as a redraw begins
    CHECK(near.begin(scene(1), kSettled));
    CHECK(near.redraw(true, 1) == Redraw::whole);
}

TEST_CASE("shadows far away follow in every eighth picture while houses change, and when they rest") {
    WideShadows wide;
    const auto at = [](uint64_t roofs) {
        ShadowScene now = scene(0);
        now.roofs = roofs;
        return now;
    };
    CHECK(wide.begin(at(1), true));
    wide.drew(at(1), glm::mat4(1));
    uint32_t drawn = 0;
    for (uint64_t roofs = 2; roofs < 34; ++roofs)
        if (wide.begin(at(roofs), true)) {
            wide.drew(at(roofs), glm::mat4(1));
            CHECK(!wide.behind());
            ++drawn;
        } else {
            CHECK(wide.behind());
        }
    CHECK(drawn == 5);  // the first, then four of thirty-one
    ShadowScene turned = at(40);
    turned.sun = {1, 0, 0};
    CHECK(wide.begin(turned, true));  // which the near half can't do without
    wide.drew(turned, glm::mat4(1));
    CHECK(!wide.begin(turned, true));
}

TEST_CASE("the sun sees all that casts from towards it, and its texels stay where they are while the sphere moves") {
    std::mt19937 random(3);
    std::uniform_real_distribution<float> unit(-1, 1);
    const glm::vec3 sunward = glm::normalize(glm::vec3(.5f, .3f, .2f)), place(1, 2, 3);
    const glm::vec3 first(makeSunView(sunward, place, 8, 90).toTexture * glm::vec4(place, 1));
    for (int i = 0; i < 100; ++i) {
        const glm::vec3 center = place + 5.0f * glm::vec3(unit(random), unit(random), unit(random));
        const SunView sun = makeSunView(sunward, center, 8, 90);
        for (float towards : {-7.9f, 0.0f, 89.9f}) {
            const glm::vec3 at(sun.toTexture * glm::vec4(center + towards * sunward, 1));
            CHECK(std::abs(at.x - .5f) < 1e-3f);
            CHECK(std::abs(at.y - .5f) < 1e-3f);
            CHECK(at.z > 0);
            CHECK(at.z < 1);
        }
        const glm::vec3 moved = (glm::vec3(sun.toTexture * glm::vec4(place, 1)) - first) * float(kShadowSize);
        CHECK(std::abs(moved.x - std::round(moved.x)) < .02f);
        CHECK(std::abs(moved.y - std::round(moved.y)) < .02f);
        CHECK(sun.depth == doctest::Approx(98));
    }
    CHECK(makeSunView(sunward, place, 8).depth == doctest::Approx(16));
}
