// A grammar's `avoid` from a host: it reaches growth, follows its parameter, and grows the same as shaders.
#include <doctest/doctest.h>

#include <string>

#include "tests/plugin/grown_square.hpp"

namespace espalier {
namespace {

struct Wall {
    EspContext* context = nullptr;
    EspGrammar grammar{};
    EspSurface surface{};

    Wall() {
        EspContextDef def = esp::defaults<EspContextDef>();
        def.log = quiet;
        REQUIRE_MESSAGE(espCreate(ESP_VERSION, &def, &context) == ESP_OK, espLastError(nullptr));
        REQUIRE(espLoadSurface(context, ESPALIER_SQUARE, nullptr, &surface) == ESP_OK);
        const std::string text = std::string("param apart = 0 [0 .. 0.5]\navoid apart\n") + kSquaresIvy;
        const EspGrammarDef ivy = esp::grammarDef("ivy", text.c_str());
        REQUIRE_MESSAGE(espCompileGrammar(context, &ivy, &grammar) == ESP_OK, espLastError(context));
        EspSeedDef seed = esp::defaults<EspSeedDef>();
        seed.grammar = grammar;
        for (int i = 0; i < 3; ++i) {
            seed.position[0] = .2f + .3f * float(i);
            seed.position[1] = .05f;
            seed.direction[1] = 1;
            seed.number = uint32_t(i);
            EspSeed planted{};
            REQUIRE(espPlant(context, &seed, &planted) == ESP_OK);
        }
    }
    ~Wall() { espDestroy(context); }

    EspStats grow() {
        REQUIRE_MESSAGE(espUpdate(context) == ESP_OK, espLastError(context));
        EspStats stats{};
        stats.structSize = sizeof stats;
        REQUIRE(espReadStats(context, &stats) == ESP_OK);
        return stats;
    }
    void apart(float metres) { REQUIRE(espSetParam(context, grammar, "apart", &metres, 1) == ESP_OK); }
};

}  // namespace

TEST_CASE("a host's grammar keeps its stems apart by a parameter, and gives the same plants back without it") {
    Wall wall;
    const EspStats free = wall.grow();
    wall.apart(.05f);
    const EspStats apart = wall.grow();
    CHECK(apart.nodes < free.nodes);
    CHECK(apart.nodes > 20);
    CHECK(apart.hash != free.hash);

    EspGrowDef grow = esp::defaults<EspGrowDef>();
    grow.shadersOnly = 1;
    REQUIRE(espSetGrow(wall.context, &grow) == ESP_OK);
    CHECK(wall.grow().hash == apart.hash);
    grow.shadersOnly = 0;
    REQUIRE(espSetGrow(wall.context, &grow) == ESP_OK);

    // Far away the plants are the same: nothing about them depends on where the world's origin is.
    EspTransform far{};
    for (int i = 0; i < 3; ++i) far.rows[i][i] = 1;
    far.rows[0][3] = 4096;
    REQUIRE(espMoveSurface(wall.context, wall.surface, &far) == ESP_OK);
    CHECK(wall.grow().hash == apart.hash);

    wall.apart(0);
    CHECK(wall.grow().hash == free.hash);
}

}  // namespace espalier
