// Seeds that move and have settings of their own; plants that are frozen.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <set>

#include "plugin_api/espalier.hpp"
#include "tests/paint/fixture.hpp"

using namespace espalier;
using namespace espalier::test;

namespace {

EspSeedInfo infoOf(const Painting& painting, EspSeed seed) {
    EspSeedInfo info{};
    painting.ok(espSeedInfo(painting.context, seed, &info));
    return info;
}

EspSeedDef defOf(const Painting& painting, EspSeed seed) {
    EspSeedDef def{};
    painting.ok(espSeedDef(painting.context, seed, &def));
    return def;
}

// Of what is drawn, metres.
float topOfGrowth(const Painting& painting) {
    EspTriangles triangles{};
    painting.ok(espMaterialise(painting.context, &triangles));
    REQUIRE(triangles.vertexCount > 0);
    float top = -1e9f;
    for (uint64_t i = 0; i < triangles.vertexCount; ++i) {
        float y = 0;
        std::memcpy(&y, static_cast<const char*>(triangles.vertices) + 16 * i + 4, sizeof y);
        top = std::max(top, y);
    }
    return top;
}

}  // namespace

TEST_CASE("seeds are listed, moved and given other numbers, and planted again from what they say of themselves") {
    Painting painting;
    const EspGrammar grammar = painting.grammar(kMaskedIvy);
    const EspSeed first = painting.plant(grammar, kFoot, kUp), second = painting.plant(grammar, {0, -.8f, 1}, kUp);
    const uint64_t both = painting.grown().hash;
    REQUIRE(espSeedCount(painting.context) == 2);
    std::set<uint32_t> ids;
    for (uint32_t i = 0; i < 2; ++i) {
        EspSeed seed{};
        painting.ok(espSeedAt(painting.context, i, &seed));
        ids.insert(seed.id);
    }
    CHECK(ids == std::set<uint32_t>{first.id, second.id});
    EspSeed none{};
    CHECK(espSeedAt(painting.context, 2, &none) == ESP_INVALID_ARGUMENT);

    const EspSeedInfo info = infoOf(painting, first);
    EspSeedDef def = defOf(painting, first), other = defOf(painting, second);
    CHECK(def.number == 1);
    CHECK(def.twin == 1);
    CHECK(other.twin == 2);
    CHECK(info.normal[0] == doctest::Approx(1));
    CHECK(info.position[1] == doctest::Approx(-.8));
    CHECK(info.direction[1] == doctest::Approx(1));
    const std::string symbols[] = {def.symbol, other.symbol};  // they go with their seeds
    def.symbol = symbols[0].c_str();
    other.symbol = symbols[1].c_str();
    // Away and planted again: the same plant, whichever of the two comes back first.
    painting.ok(espRemoveSeed(painting.context, first));
    painting.ok(espRemoveSeed(painting.context, second));
    EspSeed again{};
    painting.ok(espPlant(painting.context, &other, &again));
    CHECK(defOf(painting, again).twin == 2);
    CHECK(espPlant(painting.context, &other, &none) == ESP_INVALID_ARGUMENT);  // it is planted already
    EspSeed back{};
    painting.ok(espPlant(painting.context, &def, &back));
    CHECK(painting.grown().hash == both);

    // To another face and back; another number and back.
    const float away[3] = {-1, 0, 0}, home[3] = {1, -.8f, 0}, up[3] = {0, 1, 0};
    painting.ok(espMoveSeed(painting.context, back, away, up));
    CHECK(infoOf(painting, back).normal[0] == doctest::Approx(-1));
    CHECK(painting.grown().hash != both);
    painting.ok(espMoveSeed(painting.context, back, home, up));
    CHECK(painting.grown().hash == both);
    painting.ok(espSetSeedNumber(painting.context, back, 7, 0));
    CHECK(defOf(painting, back).twin == 1);
    CHECK(painting.grown().hash != both);
    CHECK(espSetSeedNumber(painting.context, back, 1, 2) == ESP_INVALID_ARGUMENT);
    painting.ok(espSetSeedNumber(painting.context, back, 1, 1));
    CHECK(painting.grown().hash == both);
    const float nowhere[3] = {NAN, 0, 0};
    CHECK(espMoveSeed(painting.context, back, nowhere, up) == ESP_INVALID_ARGUMENT);
    CHECK(espMoveSeed(painting.context, EspSeed{999}, home, up) == ESP_INVALID_ARGUMENT);
}

TEST_CASE("what a seed and a grammar tell as text stays where it is while others come") {
    Painting painting;
    const EspGrammar grammar = painting.grammar(kMaskedIvy);
    EspSeedDef def = esp::defaults<EspSeedDef>();
    def.grammar = grammar;
    def.symbol = "Ivy";
    EspSeed first{};
    painting.ok(espPlant(painting.context, &def, &first));
    const char *symbol = defOf(painting, first).symbol, *warnings = espGrammarWarnings(painting.context, grammar);
    for (int i = 0; i < 40; ++i) {
        painting.plant(grammar, kFoot, kUp);
        painting.grammar(kMaskedIvy);
    }
    CHECK(defOf(painting, first).symbol == symbol);
    CHECK(std::string(symbol) == "Ivy");
    CHECK(espGrammarWarnings(painting.context, grammar) == warnings);
}

TEST_CASE("a seed's own settings are those of a grammar with these settings, and outlive a recompilation") {
    Painting painting;
    const EspGrammar grammar = painting.grammar(kMaskedIvy);
    const EspSeed seed = painting.plant(grammar, kFoot, kUp);
    const uint64_t usual = painting.grown().hash;
    const float longer = 3, shorter = .5f;
    painting.ok(espSetParam(painting.context, grammar, "reach", &longer, 1));
    const uint64_t wanted = painting.grown().hash;
    const float before = 2;
    painting.ok(espSetParam(painting.context, grammar, "reach", &before, 1));
    CHECK(painting.grown().hash == usual);

    painting.ok(espSetSeedParam(painting.context, seed, "reach", &longer, 1));
    CHECK(painting.grown().hash == wanted);
    float value[3] = {};
    uint32_t count = 0;
    painting.ok(espSeedParam(painting.context, seed, "reach", value, &count));
    CHECK(count == 1);
    CHECK(value[0] == 3);
    // The grammar's own value has no say; another seed has it still.
    painting.ok(espSetParam(painting.context, grammar, "reach", &shorter, 1));
    CHECK(painting.grown().hash == wanted);
    EspGrammarDef def = esp::grammarDef("again", kMaskedIvy);
    painting.ok(espRecompileGrammar(painting.context, grammar, &def));
    CHECK(painting.grown().hash == wanted);
    const EspSeed twin = painting.plant(grammar, {-1, -.8f, 0}, kUp);
    const uint64_t two = painting.grown().hash;
    painting.ok(espSetSeedParam(painting.context, twin, "reach", &longer, 1));
    CHECK(painting.grown().hash != two);
    painting.ok(espSetSeedParam(painting.context, twin, "reach", nullptr, 0));
    CHECK(painting.grown().hash == two);
    painting.ok(espRemoveSeed(painting.context, twin));
    painting.ok(espSetParam(painting.context, grammar, "reach", &before, 1));
    painting.ok(espSetSeedParam(painting.context, seed, "reach", nullptr, 0));
    CHECK(painting.grown().hash == usual);
    CHECK(espSetSeedParam(painting.context, seed, "nothing", &longer, 1) == ESP_INVALID_ARGUMENT);
    const float bad = NAN;
    CHECK(espSetSeedParam(painting.context, seed, "reach", &bad, 1) == ESP_INVALID_ARGUMENT);
}

TEST_CASE("a frozen plant outlives edits, and comes back from bytes") {
    Painting painting;
    const EspGrammar grammar = painting.grammar(kMaskedIvy);
    const EspSeed seed = painting.plant(grammar, kFoot, kUp);
    CHECK(espFreezePlant(painting.context, seed, 1) == ESP_INVALID_ARGUMENT);  // not grown yet
    const EspStats whole = painting.grown();
    CHECK(infoOf(painting, seed).frozen == 0);
    painting.ok(espFreezePlant(painting.context, seed, 1));
    CHECK(infoOf(painting, seed).frozen == 1);
    CHECK(painting.grown().hash == whole.hash);
    const float shorter = .5f;
    painting.ok(espSetParam(painting.context, grammar, "reach", &shorter, 1));
    CHECK(painting.grown().hash == whole.hash);
    EspGrammarDef def = esp::grammarDef("again", kMaskedIvy);
    painting.ok(espRecompileGrammar(painting.context, grammar, &def));
    CHECK(painting.grown().hash == whole.hash);
    EspGrowDef grow = esp::defaults<EspGrowDef>();
    grow.maxDepth = 100;  // all anew
    painting.ok(espSetGrow(painting.context, &grow));
    CHECK(painting.grown().hash == whole.hash);
    CHECK(painting.grown().seeds == 1);
    EspPlantHit hit{};
    REQUIRE(pick(painting, {4, -.7f, 0}, {1, -.7f, 0}, &hit) == ESP_OK);
    CHECK(hit.seed.id == seed.id);

    size_t size = 0;
    painting.ok(espReadFrozen(painting.context, seed, nullptr, &size));
    std::vector<uint8_t> bytes(size);
    painting.ok(espReadFrozen(painting.context, seed, bytes.data(), &size));
    painting.ok(espFreezePlant(painting.context, seed, 0));
    const EspStats thawed = painting.grown();
    CHECK(thawed.nodes < whole.nodes);
    CHECK(espReadFrozen(painting.context, seed, nullptr, &size) == ESP_INVALID_ARGUMENT);
    const EspSeed other = painting.plant(grammar, {.7f, -.7f, 1}, kUp);
    const EspStats two = painting.grown();
    painting.ok(espFreezeAs(painting.context, seed, bytes.data(), bytes.size()));
    const EspStats put = painting.grown();
    CHECK(put.derivedNodes == 0);  // the other plant stood as it was
    CHECK(put.nodes == two.nodes - thawed.nodes + whole.nodes);
    const auto half = [](uint64_t hash, int which) { return uint32_t(hash >> (32 * which)); };  // each is a sum
    for (int i = 0; i < 2; ++i)
        CHECK(half(put.hash, i) == half(two.hash, i) - half(thawed.hash, i) + half(whole.hash, i));
    painting.ok(espRemoveSeed(painting.context, other));
    CHECK(painting.grown().hash == whole.hash);
    bytes[bytes.size() / 2] ^= 1;
    CHECK(espFreezeAs(painting.context, seed, bytes.data(), bytes.size()) == ESP_INVALID_CONTENT);
    CHECK(painting.grown().hash == whole.hash);
    painting.ok(espRemoveSeed(painting.context, seed));
    CHECK(painting.grown().nodes == 0);
}

TEST_CASE("a surface that moves takes its plants along and leaves the others alone") {
    Painting painting;
    const EspGrammar grammar = painting.grammar(kMaskedIvy);
    EspTransform away = espIdentity();
    away.rows[0][3] = 10;
    EspSurface second{};
    painting.ok(espLoadSurface(painting.context, painting.path.c_str(), &away, &second));
    painting.plant(grammar, kFoot, kUp);
    const EspStats one = painting.grown();
    const EspSeed moved = painting.plant(grammar, {10, -.7f, 1}, kUp);
    const EspStats two = painting.grown();
    REQUIRE(two.nodes > one.nodes);

    EspTransform beside = espIdentity();
    beside.rows[0][3] = -7;
    painting.ok(espMoveSurface(painting.context, second, &beside));
    const EspStats after = painting.grown();
    CHECK(after.derivedNodes == 0);
    EspGrowDef grow = esp::defaults<EspGrowDef>();
    grow.maxDepth = 100;  // all anew
    painting.ok(espSetGrow(painting.context, &grow));
    const EspStats anew = painting.grown();
    CHECK(anew.derivedNodes == anew.nodes);
    CHECK(after.hash == anew.hash);
    CHECK(after.nodes == anew.nodes);

    // Against the other one: plants of both may cross over now.
    beside.rows[0][3] = 2;
    painting.ok(espMoveSurface(painting.context, second, &beside));
    const EspStats touching = painting.grown();
    CHECK(touching.contacts > 0);
    CHECK(touching.derivedNodes == touching.nodes);
    painting.ok(espMoveSurface(painting.context, second, &away));
    const EspStats back = painting.grown();
    CHECK(back.contacts == 0);
    CHECK(back.derivedNodes == back.nodes);  // and from what they had crossed to
    CHECK(back.hash == two.hash);

    // Frozen, a plant moves along as it is, and is written where its surface stands.
    painting.ok(espFreezePlant(painting.context, moved, 1));
    CHECK(painting.grown().hash == two.hash);
    const float before = topOfGrowth(painting);
    away.rows[1][3] = 3;
    painting.ok(espMoveSurface(painting.context, second, &away));
    const EspStats along = painting.grown();
    CHECK(along.derivedNodes == 0);
    CHECK(along.hash == two.hash);
    CHECK(infoOf(painting, moved).frozen == 1);
    CHECK(topOfGrowth(painting) > before + 1);
    away.rows[0][0] = away.rows[1][1] = away.rows[2][2] = 2;
    painting.ok(espMoveSurface(painting.context, second, &away));
    CHECK(infoOf(painting, moved).frozen == 0);
}

TEST_CASE("a seed whose ground lies inside of another surface waits until that one has moved away") {
    Painting painting;
    const EspGrammar grammar = painting.grammar(kMaskedIvy);
    EspTransform away = espIdentity(), over = espIdentity();
    away.rows[0][3] = 10;
    over.rows[0][3] = 1.5f;  // from x = 0.5 on
    EspSurface second{};
    painting.ok(espLoadSurface(painting.context, painting.path.c_str(), &away, &second));
    painting.plant(grammar, {-1, -.8f, 0}, kUp);
    painting.ok(espMoveSurface(painting.context, second, &over));
    const EspStats outer = painting.grown();
    CHECK(outer.contacts > 0);
    CHECK(outer.nodes > 0);
    painting.ok(espMoveSurface(painting.context, second, &away));
    const EspStats one = painting.grown();
    painting.plant(grammar, kFoot, kUp);  // on the face x = 1
    const EspStats both = painting.grown();
    REQUIRE(both.nodes > one.nodes);

    painting.ok(espMoveSurface(painting.context, second, &over));
    const EspStats waiting = painting.grown();
    CHECK(waiting.hash == outer.hash);
    CHECK(waiting.nodes == outer.nodes);
    // One that is planted there waits too.
    const EspSeed late = painting.plant(grammar, {1, -.7f, .3f}, kUp);
    CHECK(painting.grown().hash == outer.hash);
    painting.ok(espRemoveSeed(painting.context, late));
    painting.ok(espMoveSurface(painting.context, second, &away));
    CHECK(painting.grown().nodes == both.nodes);
    CHECK(painting.grown().hash == both.hash);
}

TEST_CASE("a text that changes a rule lets what didn't use it stand, also where a seed has values of its own") {
    Painting painting;
    std::string text =
        "param reach = 1.5 [0 .. 9]\n"
        "Ivy -> Stem(reach)\n"
        "Stem(l) : arc >= l -> NULL\n"
        "Stem(l) : rand() < 0.015 -> Branch(2) {Shoot(0), Creep(l)}\n"
        "Stem(l) -> Creep(l)\n"
        "Creep(l) -> Marching(0.01, rand(-0.2, 0.2), arc < 9) {Stem(l), Wood}\n"
        "Shoot(n) -> Marching(0.01, 0.1, n < 3) {Shoot(n + 1), Wood}\n"
        "Wood -> S(0.01) Shape(\"bark\", C1)\n";
    const EspGrammar grammar = painting.grammar(text.c_str());
    const float own = 1.2f;
    for (uint32_t number = 1; number <= 8; ++number) {
        const EspSeed seed = painting.plant(grammar, {1, -.8f, .2f * float(number) - .9f}, kUp, number);
        painting.ok(espSetSeedParam(painting.context, seed, "reach", &own, 1));
    }
    const EspStats before = painting.grown();
    text.replace(text.find("n < 3"), 5, "n < 4");
    const EspGrammarDef def = esp::grammarDef("again", text);
    painting.ok(espRecompileGrammar(painting.context, grammar, &def));
    const EspStats after = painting.grown();
    CHECK(after.nodes > before.nodes);
    CHECK(after.derivedNodes > 0);
    CHECK(after.derivedNodes < after.nodes / 2);
    EspGrowDef grow = esp::defaults<EspGrowDef>();
    grow.maxDepth = 100;  // all anew
    painting.ok(espSetGrow(painting.context, &grow));
    CHECK(painting.grown().hash == after.hash);
}
