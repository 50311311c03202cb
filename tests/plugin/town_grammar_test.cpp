// A town's grammar that can't be grown: what stands stays, and the mistake is told under the grammar's name.
#include <doctest/doctest.h>

#include <cstring>
#include <string>

#include "plugin_api/espalier.hpp"
#include "tests/plugin/life.hpp"

using namespace espalier;

TEST_CASE("a grammar whose rules lead on without end leaves the last roofs, and is told of until it is mended") {
    FailingDevice device;
    Life life;
    REQUIRE(life.create(device));
    EspContext* context = life.context;
    constexpr const char* kTown = "{\"buildings\": [{\"id\": \"h\", \"outer\": [[0,0],[10,0],[10,8],[0,8]]}]}";
    const std::string good =
        "House -> Extrude(wallHeight) {NULL, Top}\nTop -> Join(roofHeight, roofPos1, roofPos2) {Shape(\"slate\"), "
        "NULL, "
        "Top}\n";
    const auto def = [](const std::string& text) { return esp::grammarDef("tiles.grammar", text); };
    EspTownDef town = esp::defaults<EspTownDef>();
    town.text = kTown;
    town.length = std::strlen(kTown);
    EspGrammarDef first = def(good);
    REQUIRE(espCompileGrammar(context, &first, &town.grammar) == ESP_OK);
    REQUIRE(espLoadTown(context, &town) == ESP_OK);
    REQUIRE_MESSAGE(espUpdate(context) == ESP_OK, espLastError(context));
    const auto roofs = [&] {
        EspRoofStats stats;
        REQUIRE(espReadRoofStats(context, &stats) == ESP_OK);
        return stats;
    };
    const EspRoofStats before = roofs();
    CHECK(before.grids == 4);
    for (const char* text : {"House -> House House\nOther -> Explode() {NULL, NULL}\n",
                             "House -> Extrude(1) {Box, NULL}\nBox -> Extrude(1) {Box, Box}\n"}) {
        const std::string endless = text;
        const EspGrammarDef changed = def(endless);
        REQUIRE(espRecompileGrammar(context, town.grammar, &changed) == ESP_OK);
        for (int frame = 0; frame < 3; ++frame) {
            CHECK(espUpdate(context) == ESP_INVALID_CONTENT);
            const std::string told = espLastError(context);
            CHECK_MESSAGE(told.find("tiles.grammar: a rule leads to itself without end") != std::string::npos, told);
            CHECK(roofs().hash == before.hash);
            CHECK(roofs().grids == before.grids);
        }
    }
    const EspGrammarDef mended = def(good);
    REQUIRE(espRecompileGrammar(context, town.grammar, &mended) == ESP_OK);
    CHECK_MESSAGE(espUpdate(context) == ESP_OK, espLastError(context));
    CHECK(roofs().hash == before.hash);
}
