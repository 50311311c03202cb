// Surfaces that move by themselves: their plants stand in their own space, and are derived anew only where they ask for
// what a move changes.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include "tests/paint/fixture.hpp"

using namespace espalier;
using namespace espalier::test;

namespace {

const glm::vec3 kAway(9, 0, 0);

// About the vertical axis, then moved.
EspTransform turnedBy(float degrees, glm::vec3 by = {}) {
    EspTransform place = movedBy(by);
    const float angle = degrees * 3.14159265f / 180;
    place.rows[0][0] = place.rows[2][2] = std::cos(angle);
    place.rows[0][2] = std::sin(angle);
    place.rows[2][0] = -std::sin(angle);
    return place;
}
EspTransform quarterTurn() {
    EspTransform place = espIdentity();
    place.rows[0][0] = place.rows[2][2] = 0;
    place.rows[0][2] = 1;
    place.rows[2][0] = -1;
    return place;
}

std::string ivyWith(const char* turn, const char* condition) {
    return std::string("context mask = 1\n") + "Ivy -> Branch(2) {Stem, Stem}\n" +
           "Stem -> Marching(0.05, rand(-0.3, 0.3) + " + turn + ", mask(texCoord) > 0.5 and arc < 2 and " + condition +
           ") {Stem, Wood}\n" + "Wood -> S(0.01) Shape(\"bark\", C1)\n";
}

// All vertices in the world, to the bit, in an order of their own.
std::vector<std::array<uint32_t, 4>> drawn(const Painting& painting) {
    EspTriangles triangles{};
    painting.ok(espMaterialise(painting.context, &triangles));
    std::vector<std::array<uint32_t, 4>> vertices(triangles.vertexCount);
    std::memcpy(vertices.data(), triangles.vertices, vertices.size() * sizeof vertices[0]);
    std::ranges::sort(vertices);
    return vertices;
}

}  // namespace

TEST_CASE("a surface that moves by itself takes its plants along, and nothing is derived") {
    for (const bool shadersOnly : {false, true}) {
        CAPTURE(shadersOnly);
        const Painting painting;
        EspGrowDef grow = painting.growBy(shadersOnly);
        const EspGrammar grammar = painting.grammar(kMaskedIvy);
        painting.another(movedBy(kAway));
        painting.plant(grammar, kFoot + kAway, kUp, 1);
        painting.plant(grammar, kFoot, kUp, 2);
        const EspStats before = painting.grown();
        const auto there = drawn(painting);
        for (const EspTransform& place : {movedBy({0, 0, 3}), turnedBy(37, {-1, 2, 3}), quarterTurn()}) {
            const uint32_t expansions = painting.grown().expansions;
            painting.ok(espMoveSurface(painting.context, painting.surface, &place));
            const EspStats moved = painting.grown();
            CHECK(moved.derivedNodes == 0);
            CHECK(moved.hash == before.hash);
            CHECK(moved.expansions == expansions);
            const auto here = drawn(painting);
            CHECK(here != there);
            grow.maxDepth += 1;
            painting.ok(espSetGrow(painting.context, &grow));
            const EspStats anew = painting.grown();
            CHECK(anew.derivedNodes == anew.nodes);
            CHECK(anew.hash == before.hash);
            CHECK(drawn(painting) == here);
        }
    }
}

TEST_CASE("plants that ask for the world are derived anew as far as a move changes what they ask for") {
    struct Case {
        const char *turn, *condition;
        bool shifts, turns;  // whether it regrows after these
    };
    for (const Case& c : {Case{"0", "position.z < 5", true, true}, Case{"0", "height < 1.5", true, true},
                          Case{"0", "normal.x > -2", false, true}, Case{"0", "heading.y > -2", false, true},
                          Case{"0", "slope < 9", false, true}, Case{"angleTo(0, 1, 0) * 0.1", "true", false, true},
                          Case{"0", "true", false, false}}) {
        CAPTURE(c.turn);
        CAPTURE(c.condition);
        const Painting painting;
        painting.another(movedBy(kAway));
        const EspGrammar plain = painting.grammar(kMaskedIvy);
        painting.plant(plain, {0, -.8f, 1}, kUp, 1);
        const uint32_t others = painting.grown().nodes;
        painting.plant(painting.grammar(ivyWith(c.turn, c.condition).c_str()), kFoot, kUp, 2);
        painting.plant(plain, kFoot + kAway, kUp, 3);
        REQUIRE(painting.grown().nodes > others);
        const EspTransform shifted = movedBy({.3f, .7f, 4}), turned = turnedBy(30, {.3f, .7f, 4});
        painting.ok(espMoveSurface(painting.context, painting.surface, &shifted));
        CHECK((painting.grown().derivedNodes > 0) == c.shifts);
        painting.hash();
        painting.ok(espMoveSurface(painting.context, painting.surface, &turned));
        const EspStats after = painting.grown();
        CHECK((after.derivedNodes > 0) == c.turns);
        CHECK(after.derivedNodes < after.nodes);
        painting.hash();
    }
}

TEST_CASE("a surface that is scaled, or comes against another or from it, has its plants derived anew") {
    const Painting painting;
    const EspGrammar grammar = painting.grammar(kMaskedIvy);
    const EspSurface other = painting.another(movedBy(kAway));
    painting.plant(grammar, {-.2f, 0, 1}, {1, 0, 0}, 1);
    painting.grown();
    EspTransform larger = movedBy(kAway);
    for (int i = 0; i < 3; ++i) larger.rows[i][i] = 1.5f;
    painting.ok(espMoveSurface(painting.context, other, &larger));
    CHECK(painting.grown().derivedNodes == 0);  // nothing stands there
    painting.plant(grammar, kFoot * 1.5f + kAway, kUp, 2);
    painting.grown();
    larger.rows[0][0] = larger.rows[1][1] = larger.rows[2][2] = 1;
    painting.ok(espMoveSurface(painting.context, other, &larger));
    CHECK(painting.grown().derivedNodes > 20);
    painting.hash();
    const EspTransform against = movedBy({1.5f, .3f, .3f}), aside = movedBy({1.5f, .3f, .35f}), away = movedBy(kAway);
    for (const EspTransform& place : {against, aside, away}) {
        painting.ok(espMoveSurface(painting.context, other, &place));
        const EspStats now = painting.grown();
        CHECK(now.derivedNodes == now.nodes);
        painting.hash();
    }
    // Away from each other again, it moves by itself.
    const EspTransform farther = movedBy(kAway * 2.f);
    painting.ok(espMoveSurface(painting.context, other, &farther));
    CHECK(painting.grown().derivedNodes == 0);
    painting.hash();
}

TEST_CASE("of two moves before a growth the one counts that concerns more") {
    const Painting painting;
    painting.plant(painting.grammar(ivyWith("angleTo(0, 1, 0) * 0.1", "true").c_str()), kFoot, kUp, 1);
    const EspStats before = painting.grown();
    const EspTransform turned = turnedBy(30), aside = turnedBy(30, {0, 0, 1});
    painting.ok(espMoveSurface(painting.context, painting.surface, &turned));
    painting.ok(espMoveSurface(painting.context, painting.surface, &aside));
    CHECK(painting.grown().derivedNodes == before.nodes);
    painting.hash();
}
