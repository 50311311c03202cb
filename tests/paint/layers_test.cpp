// Layers come and go with the grammars that read them.
#include <string>

#include "plugin_api/espalier.hpp"
#include "tests/paint/fixture.hpp"

using namespace espalier;
using namespace espalier::test;

namespace {

// kMaskedIvy, reading a layer of another name.
std::string reading(const std::string& layer) {
    std::string text = kMaskedIvy;
    for (size_t at = 0; (at = text.find("mask", at)) != std::string::npos; at += layer.size())
        text.replace(at, 4, layer);
    return text;
}

}  // namespace

TEST_CASE("a layer that no grammar reads any more makes room for another") {
    const Painting painting;
    const EspGrammar grammar = painting.grammar(kMaskedIvy);
    painting.plant(grammar, {0, -.9f, 1}, {0, 1, 0});
    const uint64_t free = painting.grown().nodes;
    REQUIRE(free > 20);
    for (int i = 0; i < 40; ++i) {
        const std::string layer = "l" + std::to_string(i), text = reading(layer);
        const EspGrammarDef def = esp::grammarDef("paint test", text);
        painting.ok(espRecompileGrammar(painting.context, grammar, &def));
        CHECK(painting.grown().nodes == free);
        // It is this layer that the plant heeds, not the one whose number it got.
        EspStroke forbidden{};
        float value = -1;
        CHECK(espLayerFilled(painting.context, layer.c_str(), &value) == 0);
        painting.ok(espFillLayer(painting.context, layer.c_str(), 0, &forbidden));
        CHECK(espLayerFilled(painting.context, layer.c_str(), &value) == 1);
        CHECK(value == 0);
        CHECK(painting.grown().nodes < free / 4);
        painting.ok(espDestroyStroke(painting.context, forbidden));
    }
    std::string many;
    for (int i = 0; i < 17; ++i) many += "context many" + std::to_string(i) + " = 1\n";
    many += kMaskedIvy;
    const EspGrammarDef def = esp::grammarDef("paint test", many);
    CHECK(espRecompileGrammar(painting.context, grammar, &def) == ESP_INVALID_CONTENT);
    CHECK(std::string(espLastError(painting.context)).find("16 are the most") != std::string::npos);
}

namespace {

// Reads the mask and 15 layers more.
std::string atTheBound(const char* letter) {
    std::string text;
    for (int i = 0; i < 15; ++i) text += std::string("context ") + letter + std::to_string(i) + " = 1\n";
    return text + kMaskedIvy;
}

}  // namespace

TEST_CASE("a grammar that reads as many layers as there may be is compiled anew with others in their place") {
    const Painting painting;
    const EspGrammar grammar = painting.grammar(atTheBound("a").c_str());
    EspSeedDef seed = esp::defaults<EspSeedDef>();
    seed.grammar = grammar;
    seed.symbol = "Ivy";
    seed.position[1] = -.9f;
    seed.position[2] = 1;
    EspSeed planted{};
    painting.ok(espPlant(painting.context, &seed, &planted));
    const float own = 1.5f;  // its copy of the rules counts no more than these
    painting.ok(espSetSeedParam(painting.context, planted, "reach", &own, 1));
    const uint64_t free = painting.grown().nodes;
    REQUIRE(free > 20);
    std::string text = atTheBound("b");
    SUBCASE("which fails") {
        text.replace(text.find("Ivy ->"), 6, "Oak ->");
        text.replace(text.find("mask = 1"), 8, "cover = 1");
        text.replace(text.find("mask(texCoord)"), 4, "cover");
        const EspGrammarDef def = esp::grammarDef("lost", text);
        CHECK(espRecompileGrammar(painting.context, grammar, &def) == ESP_INVALID_CONTENT);
        CHECK(std::string(espLastError(painting.context)).find("'Ivy'") != std::string::npos);
    }
    SUBCASE("which succeeds") {
        const EspGrammarDef def = esp::grammarDef("bound", text);
        painting.ok(espRecompileGrammar(painting.context, grammar, &def));
    }
    CHECK(painting.grown().nodes == free);
    EspStroke filled{};
    painting.ok(espFillLayer(painting.context, "mask", 0, &filled));
    CHECK(painting.grown().nodes < free / 4);
}

TEST_CASE("layers that roofs read count nothing among those of plants") {
    const Painting painting;
    std::string roofs;
    for (int i = 0; i < 8; ++i) roofs += "context roof" + std::to_string(i) + " = 0\n";
    painting.grammar((roofs + "House -> Extrude(wallHeight) {NULL, NULL}\n").c_str());
    painting.plant(painting.grammar(atTheBound("a").c_str()), {0, -.9f, 1}, {0, 1, 0});
    CHECK(painting.grown().nodes > 20);
    esp::DrawDef def;
    def.width = 32;
    def.height = 18;
    def.camera = esp::frameAll(painting.context);
    def.look.view = ESP_VIEW_LAYER;
    for (const char* name : {"mask", "roof3"}) {
        def.look.viewLayer = name;
        painting.ok(espDraw(painting.context, &def));
    }
    def.look.viewLayer = "none";
    CHECK(espDraw(painting.context, &def) == ESP_INVALID_ARGUMENT);
}

TEST_CASE("a layer that comes into being is read by grammars that wanted another value where there was none") {
    const Painting painting;
    painting.grammar(kMaskedIvy);  // what it wants is the layer's fill
    std::string text = kMaskedIvy;
    text.replace(text.find("mask = 1"), 8, "mask = 0");
    painting.plant(painting.grammar(text.c_str()), {0, -.9f, 1}, {0, 1, 0});
    const uint64_t forbidden = painting.grown().nodes;
    const std::vector<float> there = painting.layer("mask");  // the layer's fill: no texel will be another
    EspLayerDef def = esp::defaults<EspLayerDef>();
    def.surface = painting.surface;
    def.name = "mask";
    def.space = ESP_LAYER_TEXELS;
    def.texels = there.data();
    def.width = def.height = painting.size();
    EspStroke stroke{};
    painting.ok(espImportLayer(painting.context, &def, &stroke));
    const EspStats free = painting.grown();
    CHECK(free.nodes > forbidden + 20);
    EspGrowDef grow = esp::defaults<EspGrowDef>();
    grow.maxDepth = 100;  // all anew
    painting.ok(espSetGrow(painting.context, &grow));
    CHECK(painting.grown().hash == free.hash);
}

TEST_CASE("what nobody grows by any more reads no layers") {
    const Painting painting;
    const auto nine = [](const char* letter) {
        std::string text;
        for (int i = 0; i < 9; ++i) text += std::string("context ") + letter + std::to_string(i) + " = 1\n";
        return text + kMaskedIvy;
    };
    const EspGrammar first = painting.grammar(nine("a").c_str());
    const EspSeed seed = painting.plant(first, {0, -.9f, 1}, {0, 1, 0});
    const float own = 1;
    painting.ok(espSetSeedParam(painting.context, seed, "reach", &own, 1));
    painting.grown();
    painting.ok(espDestroyGrammar(painting.context, first));
    const EspGrammar second = painting.grammar(nine("b").c_str());
    painting.plant(second, {0, -.9f, 1}, {0, 1, 0});
    CHECK(painting.grown().nodes > 20);
}

TEST_CASE("a fill reaches grammars for which its value isn't the one that is there without paint") {
    const Painting painting;
    painting.grammar(kMaskedIvy);
    std::string text = kMaskedIvy;
    text.replace(text.find("mask = 1"), 8, "mask = 0");
    painting.plant(painting.grammar(text.c_str()), {0, -.9f, 1}, {0, 1, 0});
    const uint64_t forbidden = painting.grown().nodes;
    EspStroke filled{};
    painting.ok(espFillLayer(painting.context, "mask", 1, &filled));
    CHECK(painting.grown().nodes > forbidden + 20);
}

TEST_CASE("a grammar that plants grow by doesn't become one of roofs") {
    const Painting painting;
    const EspGrammar ivy = painting.grammar(kMaskedIvy);
    const char* roofs =
        "House -> Extrude(wallHeight) {NULL, Top}\nTop -> Join(roofHeight, roofPos1, roofPos2) {NULL, NULL, Top}\n";
    const EspGrammarDef def = esp::grammarDef("paint test", roofs);
    painting.ok(espRecompileGrammar(painting.context, ivy, &def));  // nobody minds
    const EspGrammarDef back = esp::grammarDef("paint test", kMaskedIvy);
    painting.ok(espRecompileGrammar(painting.context, ivy, &back));
    painting.plant(ivy, {0, -.9f, 1}, {0, 1, 0});
    const EspStats before = painting.grown();
    CHECK(espRecompileGrammar(painting.context, ivy, &def) == ESP_INVALID_CONTENT);
    CHECK(std::string(espLastError(painting.context)) == "paint test: would make roofs, yet planted seeds grow by it");
    CHECK(painting.grown().hash == before.hash);
}
