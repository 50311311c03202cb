// Layers of colours in grammars of plants.
#include "tests/grammar/support.hpp"

using namespace grammar_test;

TEST_CASE("a layer of colours is three layers, read leaf by leaf; colours of parameters stay in the map") {
    const RuleMap map = compiled(R"(context mask = 1
context tint = #ff0080 "Colour of leaves"
param green = #4a7c2f
A -> Marching(0.1, 0, mask(texCoord)) {A, Colour(tint(texCoord)) S(0.1) Shape("leaf") Colour(green) S(0.1) Shape("leaf")})");
    CHECK(map.warnings().empty());
    REQUIRE(map.contexts().size() == 4);
    const char* names[] = {"mask", "tint.r", "tint.g", "tint.b"};
    const float fills[] = {1, 1, 0, .2158605f};
    for (uint32_t i = 0; i < 4; ++i) {
        CHECK(map.contexts()[i].name == names[i]);
        CHECK(map.contexts()[i].fill == doctest::Approx(fills[i]));
    }
    const RuleMapRef ref = map.ref();
    REQUIRE(ref.terminalCount == 2);
    const TerminalRecord layer = ref.terminals.v[0], param = ref.terminals.v[1];
    for (uint32_t i = 0; i < 3; ++i) {
        CHECK(layer.colour[i].slot != kSlotImmediate);
        CHECK(param.colour[i].slot == kSlotImmediate);
    }
    CHECK(ref.extrudes.v[0].layers == 0b1110);
    CHECK((ref.features & kFeatureColours) != 0);
}
