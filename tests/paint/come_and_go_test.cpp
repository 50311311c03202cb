// Surfaces that come and go: what stands on others isn't derived again unless it can get to them.
#include <random>

#include "plugin_api/espalier.hpp"
#include "tests/paint/fixture.hpp"

using namespace espalier;
using namespace espalier::test;

namespace {

// Without touching the cube of the fixture, and against it.
const glm::vec3 kAway(9, 0, 0), kAgainst(1.5f, .3f, .3f);

}  // namespace

TEST_CASE("a surface that touches nothing comes and goes, and nothing is derived") {
    for (const bool shadersOnly : {false, true}) {
        CAPTURE(shadersOnly);
        const Painting painting;
        painting.growBy(shadersOnly);
        const EspGrammar grammar = painting.grammar(kMaskedIvy);
        painting.plant(grammar, kFoot, kUp);
        painting.plant(grammar, {0, -.8f, 1}, kUp, 2);
        const EspStats before = painting.grown();
        REQUIRE(before.derivedNodes > 50);
        const EspSurface away = painting.another(movedBy(kAway));
        const EspStats beside = painting.grown();
        CHECK(beside.derivedNodes == 0);
        CHECK(beside.expansions == before.expansions);
        CHECK(beside.hash == before.hash);
        painting.plant(grammar, kFoot + kAway, kUp, 3);
        const EspStats both = painting.grown();
        CHECK(both.derivedNodes == both.nodes - before.nodes);
        painting.ok(espDestroySurface(painting.context, away));
        const EspStats after = painting.grown();
        CHECK(after.derivedNodes == 0);
        CHECK(after.nodes == before.nodes);
        CHECK(after.hash == before.hash);
        painting.hash();
    }
}

TEST_CASE("the first surface of the table goes and another takes its place, and the second's plants stand") {
    const Painting painting;
    const EspGrammar grammar = painting.grammar(kMaskedIvy);
    const EspSurface away = painting.another(movedBy(kAway));
    painting.plant(grammar, kFoot + kAway, kUp, 1);
    const EspStats alone = painting.grown();
    painting.plant(grammar, kFoot, kUp, 2);
    painting.grown();
    painting.ok(espDestroySurface(painting.context, painting.surface));
    const EspSurface instead = painting.another(movedBy(-kAway));
    const EspStats stands = painting.grown();
    CHECK(stands.derivedNodes == 0);
    CHECK(stands.hash == alone.hash);
    painting.plant(grammar, kFoot - kAway, kUp, 3);
    CHECK(painting.grown().derivedNodes > 20);
    painting.hash();
    painting.ok(espDestroySurface(painting.context, away));
    painting.ok(espDestroySurface(painting.context, instead));
    CHECK(painting.grown().nodes == 0);
}

TEST_CASE("a surface that comes against another regrows the plants that can get to it, and no others") {
    const Painting painting;
    const EspGrammar grammar = painting.grammar(kMaskedIvy);
    painting.another(movedBy(kAway));
    painting.plant(grammar, kFoot + kAway, kUp, 1);
    const EspStats apart = painting.grown();
    painting.plant(grammar, {-.2f, 0, 1}, {1, 0, 0}, 2);
    const EspStats before = painting.grown();
    const EspSurface against = painting.another(movedBy(kAgainst));
    const EspStats joined = painting.grown();
    CHECK(joined.contacts > 0);
    CHECK(joined.hash != before.hash);
    CHECK(joined.derivedNodes == joined.nodes - apart.nodes);
    painting.hash();
    painting.ok(espDestroySurface(painting.context, against));
    CHECK(painting.grown().hash == before.hash);
    painting.hash();
}

TEST_CASE(
    "what has been painted on a surface that goes is forgotten by plants from beside it, though one like it comes") {
    const Painting painting;
    const EspGrammar grammar = painting.grammar(kMaskedIvy);
    const EspSurface against = painting.another(movedBy(kAgainst));
    painting.plant(grammar, {-.2f, 0, 1}, {1, 0, 0}, 2);
    const uint64_t bare = painting.hash();
    const float half = 0.25f;
    EspLayerDef def = esp::defaults<EspLayerDef>();
    def.surface = against;
    def.name = "mask";
    def.space = ESP_LAYER_WALK_UV;
    def.width = def.height = 1;
    def.texels = &half;
    painting.ok(espSetLayer(painting.context, &def));
    CHECK(painting.hash() != bare);
    painting.ok(espDestroySurface(painting.context, against));
    painting.another(movedBy(kAgainst));
    CHECK(painting.hash() == bare);
}

TEST_CASE("after surfaces have come, gone and moved at random, what stands is what grows anew") {
    const Painting painting(cube(2), 64);
    const EspGrammar grammar = painting.grammar(kMaskedIvy);
    std::mt19937 random(5);
    const auto below = [&](uint32_t n) { return uint32_t(random() % n); };
    // Some of these touch each other, some don't.
    const auto somewhere = [&] {
        return glm::vec3(1.5f * float(below(5)), .3f * float(below(2)), 3 * float(below(3)));
    };
    std::vector<EspSurface> surfaces{painting.surface};
    uint32_t derivedNothing = 0;
    for (uint32_t step = 0; step < 60; ++step) {
        CAPTURE(step);
        const uint32_t which = below(uint32_t(surfaces.size()));
        const EspTransform place = movedBy(somewhere());
        if (surfaces.size() < 4 || below(3) == 0) {
            surfaces.push_back(painting.another(place));
        } else if (below(2) == 0) {
            painting.ok(espDestroySurface(painting.context, surfaces[which]));
            surfaces.erase(surfaces.begin() + which);
        } else {
            painting.ok(espMoveSurface(painting.context, surfaces[which], &place));
        }
        if (below(3) == 0) painting.plant(grammar, randomOnCube(random) + somewhere(), kUp, step);
        if (below(4) == 0) continue;  // several changes before the next growth
        derivedNothing += painting.grown().derivedNodes == 0;
        painting.hash();
    }
    CHECK(derivedNothing > 5);
}
