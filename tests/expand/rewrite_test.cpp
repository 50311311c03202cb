// A grammar's new text regrows what it changes, by RuleMap::changesFrom.
#include <doctest/doctest.h>

#include "shaders/shared/random.h"
#include "tests/expand/session.hpp"

using namespace espalier;
using namespace espalier::growthtest;

TEST_CASE("a text that draws something else on spans derives nothing again") {
    Session s(flatSquare());
    for (int i = 0; i < 40; ++i) s.scene.plant({-0.75f, 0, -0.78f + 0.04f * float(i)}, {1, 0, 0}, 0, uint64_t(i));
    s.check();
    const GrowthStats before = s.growth->stats();
    const auto drawn = [&](const std::string& from, const std::string& to) {
        const RuleChanges what = s.rewrite(from, to);
        CHECK(!what.all);
        CHECK(what.uses == 0);
        CHECK(what.extrudes);
    };
    SUBCASE("leaves, fewer and with more code") {
        drawn("rand(0, 3) * cover(texCoord)", "min(rand(0, 2), arc * 100) * cover(texCoord)");
        s.check();
        CHECK(s.growth->stats().leaves != before.leaves);
    }
    SUBCASE("leaves twice") {
        drawn("Cover -> Bark Leaves", "Cover -> Bark Leaves Leaves");
        s.check();
        CHECK(s.growth->stats().leaves > before.leaves);
    }
    SUBCASE("bark, as thick at its tip as at its foot") {
        drawn("0.002 + 0.01 * clamp(toTip / 0.5, 0, 1)", "0.01");
        s.check();
        CHECK(s.growth->stats().leaves == before.leaves);
    }
    CHECK(s.growth->stats().derived == 0);
    CHECK(s.growth->stats().nodes == before.nodes);
    CHECK(s.growth->stats().regrowths == before.regrowths + 1);
}

TEST_CASE("a text that changes a rule derives what used it: little of a rule of tips, all of that of stems") {
    Session s(flatSquare());
    for (int i = 0; i < 40; ++i) s.scene.plant({-0.75f, 0, -0.78f + 0.04f * float(i)}, {1, 0, 0}, 0, uint64_t(i));
    s.set(0, "twigs", 0.05f);  // or there are more chunks of tips than all that edits go through
    s.check();
    const uint32_t guided = s.growth->stats().nodes;
    s.scene.plantMany(20, 1, 2);
    s.check();
    const GrowthStats before = s.growth->stats();
    const auto derived = [&](const std::string& from, const std::string& to) {
        CHECK(!s.rewrite(from, to).all);
        s.check();
        CHECK(s.growth->stats().regrowths > before.regrowths);
        CHECK(s.growth->stats().derived > 0);
        return s.growth->stats().derived;
    };
    SUBCASE("tips") {
        CHECK(derived("n < 3) {Tip(n + 1)", "n < 4) {Tip(n + 1)") < before.nodes / 4);
        CHECK(s.growth->stats().hash != before.hash);
        derived("n < 4) {Tip(n + 1)", "n < 3) {Tip(n + 1)");
        CHECK(s.growth->stats().hash == before.hash);
    }
    SUBCASE("stems, but not the other grammar's") {
        CHECK(derived("Fork(n + 1), Cover}", "Fork(n + 2), Cover}") <= guided);
    }
    SUBCASE("tips that end in a shape with a rule of its own, which comes and goes") {
        const char* plain = "Tip(n + 1), Cover}";
        const char* more = "End(n + 1), Cover}\nEnd(n) -> Marching(0.01, 0.1, n < 6) {End(n + 2), Cover}";
        CHECK(derived(plain, more) < before.nodes / 4);
        CHECK(derived(more, plain) < before.nodes / 4);
        CHECK(s.growth->stats().hash == before.hash);
    }
    SUBCASE("a rule before all others, which gives all of them another number") {
        s.rewrite("Stem(n) -> Marching",
                  "First(n) -> Marching(0.5, 0, n < 2) {Stem(n + 1), Cover}\nStem(n) -> Marching");
        s.check();
    }
    SUBCASE("a shape by another name") {
        for (size_t at = 0; (at = s.text.find("Tip(", at)) != std::string::npos;) s.text.replace(at, 4, "End(");
        CHECK(!s.write(0, s.text).all);
        s.check();
        CHECK(s.growth->stats().hash != before.hash);
    }
    SUBCASE("a parameter in place of a number") {
        s.rewrite("\"Twigs\"\n", "\"Twigs\"\nparam tiny = 0.03 [0.01 .. 1] \"m\" \"Tips\"\n");
        CHECK(derived("Marching(0.02, rand(-1, 1)", "Marching(tiny, rand(-1, 1)") < before.nodes / 4);
        s.set(0, "tiny", 0.02f);
        s.check();
        CHECK(s.growth->stats().derived < before.nodes / 4);
        CHECK(s.growth->stats().hash == before.hash);
    }
    SUBCASE("leaves that read a layer which nothing has read before") {
        s.rewrite("floor(rand(0, 3) * cover(texCoord))", "floor(rand(0, 3))");
        s.changes.everything = true;
        s.check();
        s.rewrite("floor(rand(0, 3))", "floor(rand(0, 3) * cover(texCoord))");
        s.check();
        s.dab(1, {0.5f, 0.5f}, 0.2f, 0);
        s.check();
    }
}

TEST_CASE("a dab and a text of both rules and leaves that come before anything grows again") {
    Session s(flatSquare());
    for (int i = 0; i < 40; ++i) s.scene.plant({-0.75f, 0, -0.78f + 0.04f * float(i)}, {1, 0, 0}, 0, uint64_t(i));
    s.check();
    s.dab(0, {0.5f, 0.5f}, 0.1f, 0);
    s.rewrite("n < 3) {Tip(n + 1)", "n < 4) {Tip(n + 1)");
    s.rewrite("S(leafSize * rand(0.6, 1))", "S(leafSize)");
    s.check();
}

TEST_CASE("leaves that come to read a layer which rules of a text before read, but not where they grow") {
    Session s(flatSquare());
    for (int i = 0; i < 40; ++i) s.scene.plant({-0.75f, 0, -0.78f + 0.04f * float(i)}, {1, 0, 0}, 0, uint64_t(i));
    s.set(0, "twigs", 0.05f);
    s.rewrite("floor(rand(0, 3) * cover(texCoord))", "floor(rand(0, 3))");
    s.changes.everything = true;
    s.check();
    const uint32_t nodes = s.growth->stats().nodes;
    s.rewrite("n < 3) {Tip(n + 1)", "n < 3 and cover(texCoord) > 0.1) {Tip(n + 1)");
    s.check();
    CHECK(s.growth->stats().derived < nodes / 4);
    s.rewrite("floor(rand(0, 3))", "floor(rand(0, 3) * cover(texCoord))");
    s.check();
    s.dab(1, {0.5f, 0.5f}, 0.2f, 0);
    s.check();
}

// What goes on by itself where there is no mask is a branch where there is one: its key is the same, so that a chunk
// that began a branch comes to go on with its parent's.
TEST_CASE("branches that edits turn into what goes on, and back") {
    Session s(cube());
    const char* turning = R"(
context mask = 1
context cover = 1
Stem(n) -> Marching(0.3, rand(-0.4, 0.4), n < 80) {Fork(n + 1), Cover}
Fork(n) : mask(texCoord) > 0.5 -> Branch(2) {Twig(n), Stem(n)}
Fork(n) -> Twig(n)
Twig(n) -> Marching(0.3, rand(-0.6, 0.6), n < 90) {Twig(n + 7), Cover}
Cover -> S(0.001) Shape("bark", C1)
)";
    s.write(0, turning);
    s.changes.everything = true;
    s.scene.plantMany(300);
    s.check();
    for (uint32_t i = 0; i < 24; ++i) {
        const auto random = [&](uint32_t which) { return uniformRandom(mix64(i), which); };
        s.dab(0, {random(1), random(2)}, 0.03f + 0.1f * random(3), float(i % 2));
        s.check();
    }
    CHECK(s.growth->stats().regrowths >= 20);
}
