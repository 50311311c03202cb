// Frozen plants whose seeds change their number before growth has seen it, or hadn't grown: each is the plant that it
// was frozen with.
#include "tests/paint/fixture.hpp"

using namespace espalier;
using namespace espalier::test;

namespace {

// Two seeds of numbers 1 and 2 on the cube's side, and what each grows alone.
struct TwoSeeds {
    Painting painting;
    EspGrammar grammar = painting.grammar(kMaskedIvy);
    EspSeed a = painting.plant(grammar, {1, -.8f, 0}, kUp, 1);
    uint64_t ofA = painting.grown().hash;
    EspSeed b = painting.plant(grammar, {0, -.8f, 1}, kUp, 2);
    uint64_t both = painting.grown().hash;

    void number(EspSeed seed, uint32_t to) const { painting.ok(espSetSeedNumber(painting.context, seed, to, 1)); }
    void freeze(EspSeed seed, int frozen = 1) const { painting.ok(espFreezePlant(painting.context, seed, frozen)); }
    uint64_t hash() const { return painting.hash(); }
};

}  // namespace

TEST_CASE("a frozen plant that gets the number of one that goes is still itself") {
    const TwoSeeds two;
    two.freeze(two.a);
    CHECK(two.hash() == two.both);
    two.painting.ok(espRemoveSeed(two.painting.context, two.b));
    two.number(two.a, 2);
    CHECK(two.hash() == two.ofA);
}

TEST_CASE("a plant that is frozen after its seed got another's number is what grew from this seed") {
    const TwoSeeds two;
    two.number(two.b, 3);
    two.number(two.a, 2);
    two.freeze(two.a);
    two.painting.ok(espRemoveSeed(two.painting.context, two.b));
    CHECK(two.hash() == two.ofA);
}

TEST_CASE("frozen plants that exchange their numbers stay where they are") {
    const TwoSeeds two;
    two.freeze(two.a);
    two.freeze(two.b);
    CHECK(two.hash() == two.both);
    two.number(two.a, 3);
    two.number(two.b, 1);
    two.number(two.a, 2);
    CHECK(two.hash() == two.both);
    two.painting.ok(espRemoveSeed(two.painting.context, two.b));
    CHECK(two.hash() == two.ofA);
}

TEST_CASE("a plant that is given to a seed that waits counts from then on") {
    const Painting painting;
    EspTransform over = espIdentity();
    over.rows[0][3] = 1.5f;  // from x = 0.5 on
    painting.another(over);
    const EspGrammar grammar = painting.grammar(kMaskedIvy);
    const EspSeed free = painting.plant(grammar, {-1, -.8f, 0}, kUp),
                  waiting = painting.plant(grammar, {1, -.8f, 0}, kUp, 2);
    const EspStats one = painting.grown();
    CHECK(one.seeds == 1);
    painting.ok(espFreezePlant(painting.context, free, 1));
    size_t size = 0;
    painting.ok(espReadFrozen(painting.context, free, nullptr, &size));
    std::vector<char> bytes(size);
    painting.ok(espReadFrozen(painting.context, free, bytes.data(), &size));
    painting.ok(espFreezePlant(painting.context, free, 0));
    CHECK(painting.grown().hash == one.hash);
    painting.ok(espFreezeAs(painting.context, waiting, bytes.data(), bytes.size()));
    const EspStats two = painting.grown();
    CHECK(two.seeds == 2);
    CHECK(two.nodes == 2 * one.nodes);
    CHECK(two.derivedNodes == 0);
    CHECK(two.expansions == one.expansions + 1);
}
