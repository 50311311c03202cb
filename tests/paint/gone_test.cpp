// Surfaces that go while plants stand on them: what has grown stands until it grows anew, and no plant is kept that
// stands on nothing.
#include <cmath>
#include <cstring>

#include "plugin_api/espalier.hpp"
#include "tests/paint/fixture.hpp"

using namespace espalier;
using namespace espalier::test;

namespace {

// Two cubes that run into each other. A stem goes from the first over to the second.
struct TwoCubes {
    Painting painting;
    EspSurface second = painting.another(movedBy({1.5f, .3f, .3f}));
    EspGrammar grammar = painting.grammar(kMaskedIvy);
    EspSeed seed = painting.plant(grammar, {-.2f, 0, 1}, {1, 0, 0});
    EspStats whole = painting.grown();

    // To the bit.
    std::vector<uint32_t> vertices() const {
        EspTriangles triangles{};
        painting.ok(espMaterialise(painting.context, &triangles));
        std::vector<uint32_t> words(triangles.vertexCount * 4);
        std::memcpy(words.data(), triangles.vertices, words.size() * sizeof(uint32_t));
        return words;
    }
};

}  // namespace

TEST_CASE("plants are drawn as they stand when a surface of theirs has gone, until they grow anew") {
    const TwoCubes two;
    const std::vector<uint32_t> before = two.vertices();
    REQUIRE(before.size() > 1000);
    two.painting.ok(espDestroySurface(two.painting.context, two.second));
    CHECK(two.vertices() == before);
    const EspStats alone = two.painting.grown();
    CHECK(alone.hash != two.whole.hash);  // it was over there
    CHECK(two.vertices() != before);
    two.painting.another(movedBy({1.5f, .3f, .3f}));
    CHECK(two.painting.grown().hash == two.whole.hash);
    CHECK(two.vertices() == before);
}

TEST_CASE("a plant whose surface has gone, or is larger, isn't frozen before it has grown anew") {
    const TwoCubes two;
    EspContext* context = two.painting.context;
    two.painting.ok(espDestroySurface(context, two.second));
    CHECK(espFreezePlant(context, two.seed, 1) == ESP_INVALID_ARGUMENT);
    CHECK(std::string(espLastError(context)).find("is gone") != std::string::npos);
    two.painting.grown();
    two.painting.ok(espFreezePlant(context, two.seed, 1));
    size_t size = 0;
    two.painting.ok(espReadFrozen(context, two.seed, nullptr, &size));
    std::vector<char> bytes(size);
    two.painting.ok(espReadFrozen(context, two.seed, bytes.data(), &size));
    two.painting.ok(espFreezeAs(context, two.seed, bytes.data(), size));
    two.painting.ok(espFreezePlant(context, two.seed, 0));
    two.painting.grown();
    // Moved against the one that it goes over to.
    const EspSurface again = two.painting.another(movedBy({1.5f, .3f, .3f}));
    two.painting.grown();
    const EspTransform aside = movedBy({1.5f, .3f, .35f});
    two.painting.ok(espMoveSurface(context, again, &aside));
    CHECK(espFreezePlant(context, two.seed, 1) == ESP_INVALID_ARGUMENT);
    two.painting.grown();
    two.painting.ok(espFreezePlant(context, two.seed, 1));
    two.painting.ok(espFreezePlant(context, two.seed, 0));
    EspTransform larger = espIdentity();
    for (int i = 0; i < 3; ++i) larger.rows[i][i] = 1.5f;
    two.painting.ok(espMoveSurface(context, two.painting.surface, &larger));
    CHECK(espFreezePlant(context, two.seed, 1) == ESP_INVALID_ARGUMENT);
}

TEST_CASE("shaders grow what native code grows where the only surface isn't the first of the table") {
    const Painting painting;
    const EspSurface second = painting.another(movedBy({5, 0, 0}));
    painting.ok(espDestroySurface(painting.context, painting.surface));
    painting.plant(painting.grammar(kMaskedIvy), kFoot + glm::vec3(5, 0, 0), kUp);
    const EspStats native = painting.grown();
    CHECK(native.nodes > 20);
    EspGrowDef grow = esp::defaults<EspGrowDef>();
    grow.shadersOnly = 1;
    painting.ok(espSetGrow(painting.context, &grow));
    CHECK(painting.grown().hash == native.hash);
    painting.ok(espDestroySurface(painting.context, second));
}

TEST_CASE("a frozen plant turns with its surface, by any angle") {
    const Painting painting;
    const EspGrammar grammar = painting.grammar(kMaskedIvy);
    const EspSeed seed = painting.plant(grammar, {0, -.9f, 1}, {0, 1, 0});
    painting.grown();
    painting.ok(espFreezePlant(painting.context, seed, 1));
    for (int degrees = 0; degrees < 360; degrees += 5) {
        CAPTURE(degrees);
        EspTransform turned = espIdentity();
        const float angle = float(degrees) * 3.14159265f / 180;
        turned.rows[0][0] = turned.rows[2][2] = std::cos(angle);
        turned.rows[0][2] = std::sin(angle);
        turned.rows[2][0] = -std::sin(angle);
        painting.ok(espMoveSurface(painting.context, painting.surface, &turned));
        REQUIRE(painting.grown().derivedNodes == 0);
        EspSeedInfo info{};
        painting.ok(espSeedInfo(painting.context, seed, &info));
        REQUIRE(info.frozen == 1);
    }
}

TEST_CASE("what stood against a surface that has gone is moved as if it had never been there") {
    const TwoCubes two;
    two.painting.ok(espDestroySurface(two.painting.context, two.second));
    const EspTransform aside = movedBy({0, 0, 3});
    two.painting.ok(espMoveSurface(two.painting.context, two.painting.surface, &aside));
    const uint64_t moved = two.painting.grown().hash;
    const Painting alone;
    alone.plant(alone.grammar(kMaskedIvy), {-.2f, 0, 1}, {1, 0, 0});
    CHECK(alone.grown().hash == moved);
}
