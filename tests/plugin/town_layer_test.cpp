// What is painted over a town and what is painted on surfaces.
#include <doctest/doctest.h>

#include <cstring>

#include "tests/plugin/life.hpp"

using namespace espalier;

namespace {

EspGrammar compiled(EspContext* context, const char* name, const char* text) {
    const EspGrammarDef def{name, text, std::strlen(text)};
    EspGrammar grammar{};
    REQUIRE_MESSAGE(espCompileGrammar(context, &def, &grammar) == ESP_OK, espLastError(context));
    return grammar;
}

void dab(EspContext* context, const char* layer) {
    EspBrush brush = espDefaultBrush();
    brush.layer = layer;
    brush.radius = 3;
    EspStroke stroke{};
    const EspDab at = {{.5f, .5f, 0}, {0, 0, 1}, 1};
    REQUIRE(espBeginStroke(context, &brush, &stroke) == ESP_OK);
    REQUIRE(espStrokeDabs(context, stroke, &at, 1) == ESP_OK);
    REQUIRE(espEndStroke(context, stroke) == ESP_OK);
}

}  // namespace

TEST_CASE("a layer that roofs alone read is painted over the town, and on surfaces once plants read it") {
    FailingDevice device;
    Life life;
    REQUIRE((life.create(device) && life.load()));
    EspContext* context = life.context;
    constexpr const char* kTown = "{\"buildings\": [{\"id\": \"h\", \"outer\": [[0,0],[10,0],[10,8],[0,8]]}]}";
    EspTownDef town = espDefaultTownDef();
    town.text = kTown;
    town.length = std::strlen(kTown);
    town.grammar = compiled(context, "roofs",
                            "context decay = 0\ncontext moss = 0\nHouse -> Extrude(wallHeight) {NULL, Top}\n"
                            "Top -> Join(roofHeight, roofPos1, roofPos2) {Cover, NULL, Top}\n"
                            "Cover -> Repeat(XY, vec2(0.3, 0.25), bond) {Tile}\n"
                            "Tile -> Drop(decay) Moss(moss) Shape(\"slate\")\n");
    REQUIRE(espLoadTown(context, &town) == ESP_OK);
    EspStroke filled{};
    dab(context, "decay");
    REQUIRE(espFillLayer(context, "moss", .5f, &filled) == ESP_OK);
    CHECK(espTownLayerCount(context) == 2);
    CHECK(espPaintedLayerCount(context) == 0);
    dab(context, "mask");  // nobody's: a surface's, for who will read it
    CHECK(espPaintedLayerCount(context) == 1);
    compiled(context, "ivy", "context decay = 0\nA -> Marching(0.1, 0, decay(texCoord) > 0.5) {A}\n");
    dab(context, "decay");
    CHECK(espPaintedLayerCount(context) == 2);
}
