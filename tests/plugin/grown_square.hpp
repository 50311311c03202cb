#pragma once

#include <doctest/doctest.h>

#include "plugin_api/espalier.hpp"

namespace espalier {

constexpr const char* kSquaresIvy =
    "Ivy -> Branch(5) {Stem(1.2), Stem(1.1), Stem(1), Stem(.9), Stem(.8)}\n"
    "Stem(l) : arc >= l -> NULL\n"
    "Stem(l) -> Marching(0.04, rand(-0.35, 0.35), true) {Stem(l), Wood Foliage}\n"
    "Wood -> S(0.02) Shape(\"bark\", C1)\n"
    "Foliage -> Repeat(3) {S(0.11) T(rand(), 0.04) R(rand(-1, 1), 0.3) Shape(\"leaf\")}\n";

inline void quiet(void*, EspLogLevel, const char*) {}

// Ivy on the square from (0,0,0) to (1,1,0).
struct GrownSquare {
    EspContext* context = nullptr;

    explicit GrownSquare(const EspHostDevice& device) {
        EspContextDef def = esp::defaults<EspContextDef>();
        def.host = &device;
        def.log = quiet;
        REQUIRE_MESSAGE(espCreate(ESP_VERSION, &def, &context) == ESP_OK, espLastError(nullptr));
        EspSurface wall{};
        REQUIRE(espLoadSurface(context, ESPALIER_SQUARE, nullptr, &wall) == ESP_OK);
        const EspGrammarDef text = esp::grammarDef("ivy", kSquaresIvy);
        EspSeedDef seed = esp::defaults<EspSeedDef>();
        REQUIRE_MESSAGE(espCompileGrammar(context, &text, &seed.grammar) == ESP_OK, espLastError(context));
        for (int i = 0; i < 3; ++i) {
            seed.position[0] = .2f + .3f * float(i);
            seed.position[1] = .05f;
            seed.direction[1] = 1;
            seed.number = uint32_t(i);
            EspSeed planted{};
            REQUIRE(espPlant(context, &seed, &planted) == ESP_OK);
        }
        REQUIRE_MESSAGE(espUpdate(context) == ESP_OK, espLastError(context));
    }
    ~GrownSquare() { espDestroy(context); }
};

}  // namespace espalier
