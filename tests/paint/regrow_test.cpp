// What regrows after an edit, and what doesn't: by counters and hashes, against growth anew.
#include <algorithm>

#include "plugin_api/espalier.hpp"
#include "tests/paint/fixture.hpp"

using namespace espalier;
using namespace espalier::test;

TEST_CASE("a text that says the same in other words grows nothing anew, and any other does") {
    Painting painting;
    const EspGrammar grammar = painting.grammar(kMaskedIvy);
    painting.plant(grammar, {1, -.9f, 0}, {0, 1, 0});
    const EspStats first = painting.grown();
    const auto expansions = [&](std::string text) {
        const EspGrammarDef def = esp::grammarDef("words", text);
        painting.ok(espRecompileGrammar(painting.context, grammar, &def));
        return painting.grown().expansions;
    };
    const auto with = [](const char* old, const char* replacement) {
        std::string text = kMaskedIvy;
        const size_t at = text.find(old);
        REQUIRE(at != std::string::npos);
        return text.replace(at, std::strlen(old), replacement);
    };
    CHECK(expansions("// the same\n\n" + with("reach = 2 [0 .. 9]", "reach = 3 [0 .. 9] \"m\" \"Length\"")) ==
          first.expansions);
    CHECK(painting.grown().hash == first.hash);
    EspParamInfo reach;
    painting.ok(espParamInfo(painting.context, grammar, 0, &reach));
    CHECK(std::string(reach.label) == "Length");
    CHECK(reach.value[0] == 2);
    CHECK(reach.initial[0] == 3);
    // What is told of that text is of use: a parameter, a layer.
    const float longer = 3;
    painting.ok(espSetParam(painting.context, grammar, "reach", &longer, 1));
    const EspStats long_ = painting.grown();
    CHECK(long_.hash != first.hash);
    CHECK(expansions(with("reach * 0.7", "reach * 0.6")) > long_.expansions);
    CHECK(painting.grown().hash != long_.hash);
    CHECK(expansions(kMaskedIvy) > long_.expansions + 1);
    CHECK(painting.grown().hash == long_.hash);
    const uint32_t before = painting.grown().expansions;
    CHECK(expansions(with("mask = 1", "mask = 0.75")) > before);  // where nothing is painted
    CHECK(expansions(with("mask = 1\n", "mask = 0.75\ncontext other = 0\n")) > before);
}

TEST_CASE("growth follows strokes, their undoing and redoing, and is idle when they touch nothing it reads") {
    Painting painting;
    const EspGrammar grammar = painting.grammar(kMaskedIvy);
    painting.plant(grammar, {1, -.9f, 0}, {0, 1, 0});
    const EspStats free = painting.grown();
    CHECK(free.nodes > 20);
    EspBrush brush = brushOn("mask", .5f, 1, .8f);
    brush.value = 0;
    const EspStroke wall = painting.stroke(brush, {dabAt({1, 0, -.5f}), dabAt({1, 0, 0}), dabAt({1, 0, .5f})});
    const EspStats stopped = painting.grown();
    CHECK(stopped.hash != free.hash);
    painting.ok(espSwapStroke(painting.context, wall));
    CHECK(painting.grown().hash == free.hash);
    painting.ok(espSwapStroke(painting.context, wall));
    CHECK(painting.grown().hash == stopped.hash);
    const uint32_t expansions = painting.grown().expansions;
    painting.stroke(brushOn("unread", .5f), {dabAt({1, 0, 0})});
    painting.stroke(brush, {dabAt({9, 0, 0})});
    CHECK(painting.grown().expansions == expansions);
}

TEST_CASE("a dab beside a plant costs no growth, nor does its undoing, and dabs on it leave what growing anew gives") {
    // Straight up, 64 steps of 2.5 cm, so that its nodes lie in z = 0.
    const char* text =
        "context mask = 1\n"
        "Ivy -> Stem\n"
        "Stem : arc >= 1.6 -> NULL\n"
        "Stem -> Marching(0.025, 0, mask(texCoord) > 0.5) {Stem, Wood}\n"
        "Wood -> S(0.01) Shape(\"bark\", C1)\n";
    Painting painting;
    painting.plant(painting.grammar(text), {1, -.9f, 0}, {0, 1, 0});
    const EspStats free = painting.grown();
    REQUIRE(free.nodes > 60);
    // Farther away than a read reaches, a texel and a half of 6 cm at most, and within the same blocks of 8 texels.
    EspBrush brush = brushOn("mask", .04f, 1, .9f);
    brush.value = 0;
    std::vector<EspDab> dabs;
    for (float z : {-.25f, -.2f, -.16f, .16f, .2f, .25f})
        for (float y : {-.5f, -.2f, .1f, .3f}) dabs.push_back(dabAt({1, y, z}));
    std::vector<EspStroke> beside;
    for (const EspDab& dab : dabs) beside.push_back(painting.stroke(brush, {dab}));
    const std::vector<float> layer = painting.layer("mask");
    CHECK(std::count(layer.begin(), layer.end(), 1.f) < int(layer.size()) - 12);
    CHECK(painting.grown().expansions == free.expansions);
    for (size_t i = beside.size(); i-- > 0;) painting.ok(espSwapStroke(painting.context, beside[i]));
    CHECK(painting.grown().expansions == free.expansions);
    for (const EspStroke& stroke : beside) painting.ok(espSwapStroke(painting.context, stroke));
    CHECK(painting.grown().expansions == free.expansions);
    CHECK(painting.layer("mask") == layer);
    // Likewise what fills the layer, or is read into it, and changes just these texels.
    EspStroke filled{}, imported{};
    painting.ok(espFillLayer(painting.context, "mask", 1, &filled));
    CHECK(painting.layer("mask") != layer);
    CHECK(painting.grown().expansions == free.expansions);
    EspLayerDef def = esp::defaults<EspLayerDef>();
    def.surface = painting.surface;
    def.name = "mask";
    def.space = ESP_LAYER_TEXELS;
    def.texels = layer.data();
    def.width = def.height = painting.size();
    painting.ok(espImportLayer(painting.context, &def, &imported));
    CHECK(painting.layer("mask") == layer);
    CHECK(painting.grown().expansions == free.expansions);
    // Across it, one after the other; it goes round them.
    EspBrush wide = brush;
    wide.radius = .09f;
    std::vector<EspDab> across;
    uint64_t before = free.hash;
    for (float y : {.5f, .2f, -.3f}) {
        across.push_back(dabAt({1, y, .02f}));
        const EspStroke dab = painting.stroke(wide, {across.back()});
        const EspStats now = painting.grown();
        CHECK(now.hash != before);
        // Taken back and done again: no more is derived than by the dab itself.
        painting.ok(espSwapStroke(painting.context, dab));
        const EspStats undone = painting.grown();
        CHECK(undone.hash == before);
        painting.ok(espSwapStroke(painting.context, dab));
        const EspStats redone = painting.grown();
        CHECK(redone.hash == now.hash);
        CHECK(redone.derivedNodes <= now.derivedNodes);
        before = now.hash;
        Painting other;
        other.plant(other.grammar(text), {1, -.9f, 0}, {0, 1, 0});
        other.stroke(brush, dabs);
        other.stroke(wide, across);
        CHECK(other.grown().hash == now.hash);
    }
}

TEST_CASE("a parameter that only a direction is worked out from grows plants anew") {
    const Painting painting;
    const EspGrammar vine = painting.grammar(
        "param wind = 0 [-3 .. 3]\n"
        "Vine -> Branch(2) {Go, Go}\n"
        "Go : arc > 2 -> NULL\n"
        "Go -> Marching(0.05, angleTo(wind, 1, 0) * 0.3, true) {Go, Wood}\n"
        "Wood -> S(0.01) Shape(\"bark\", C1)\n");
    painting.plant(vine, kFoot, kUp);
    const uint64_t calm = painting.hash();
    const float wind = 2;
    painting.ok(espSetParam(painting.context, vine, "wind", &wind, 1));
    CHECK(painting.hash() != calm);
}
