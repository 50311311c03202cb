// Plants whose ground another surface buries: they grow anew around it, and as before when it has moved away.
#include <cstring>

#include "tests/paint/fixture.hpp"

using namespace espalier;
using namespace espalier::test;

namespace {

const glm::vec3 kFoot(1, -.8f, 0), kUp(0, 1, 0);

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

TEST_CASE("a plant that another surface swallows whole, without a contact, is gone until that has moved away") {
    Painting painting;
    const EspGrammar grammar = painting.grammar(kMaskedIvy);
    const EspTransform away = placed({10, 0, 0}), around = placed({.1f, .2f, 0}, 2);
    EspSurface second{};
    painting.ok(espLoadSurface(painting.context, painting.path.c_str(), &away, &second));
    painting.plant(grammar, kFoot, kUp);
    const EspStats before = painting.grown();
    REQUIRE(before.nodes > 0);
    for (int times = 0; times < 2; ++times) {
        painting.ok(espMoveSurface(painting.context, second, &around));
        const EspStats swallowed = painting.grown();
        CHECK(swallowed.contacts == 0);
        CHECK(swallowed.nodes == 0);
        painting.ok(espMoveSurface(painting.context, second, &away));
        CHECK(painting.grown().hash == before.hash);
    }
}
