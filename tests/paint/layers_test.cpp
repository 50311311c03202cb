// Layers come and go with the grammars that read them.
#include <string>

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
        const EspGrammarDef def{"paint test", text.c_str(), text.size()};
        painting.ok(espRecompileGrammar(painting.context, grammar, &def));
        CHECK(painting.grown().nodes == free);
        // It is this layer that the plant heeds, not the one whose number it got.
        EspStroke forbidden{};
        painting.ok(espFillLayer(painting.context, layer.c_str(), 0, &forbidden));
        CHECK(painting.grown().nodes < free / 4);
        painting.ok(espDestroyStroke(painting.context, forbidden));
    }
    std::string many;
    for (int i = 0; i < 17; ++i) many += "context many" + std::to_string(i) + " = 1\n";
    many += kMaskedIvy;
    const EspGrammarDef def{"paint test", many.c_str(), many.size()};
    CHECK(espRecompileGrammar(painting.context, grammar, &def) == ESP_INVALID_CONTENT);
    CHECK(std::string(espLastError(painting.context)).find("16 are the most") != std::string::npos);
}
