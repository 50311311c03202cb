#pragma once

// Towns in a context of a test's own, and what is painted over them.

#include <doctest/doctest.h>

#include <cstring>
#include <string>
#include <vector>

#include "plugin_api/espalier.hpp"
#include "tests/plugin/life.hpp"

namespace espalier {

inline EspGrammar compiled(EspContext* context, const char* name, const std::string& text) {
    const EspGrammarDef def = esp::grammarDef(name, text);
    EspGrammar grammar{};
    REQUIRE_MESSAGE(espCompileGrammar(context, &def, &grammar) == ESP_OK, espLastError(context));
    return grammar;
}

inline EspBrush brushOn(const char* layer, float radius) {
    EspBrush brush = esp::defaults<EspBrush>();
    brush.layer = layer;
    brush.radius = radius;
    return brush;
}

inline EspStroke stroke(EspContext* context, const EspBrush& brush, const EspDab& at) {
    EspStroke made{};
    REQUIRE(espBeginStroke(context, &brush, &made) == ESP_OK);
    REQUIRE(espStrokeDabs(context, made, &at, 1) == ESP_OK);
    REQUIRE(espEndStroke(context, made) == ESP_OK);
    return made;
}

inline void load(EspContext* context, EspGrammar grammar, const char* text) {
    EspTownDef town = esp::defaults<EspTownDef>();
    town.text = text;
    town.length = std::strlen(text);
    town.grammar = grammar;
    REQUIRE(espLoadTown(context, &town) == ESP_OK);
}

inline std::vector<float> layerOf(EspContext* context, const char* name) {
    uint32_t side = 0;
    REQUIRE(espReadTownLayer(context, name, nullptr, &side) == ESP_OK);
    std::vector<float> texels(size_t(side) * side);
    REQUIRE(espReadTownLayer(context, name, texels.data(), &side) == ESP_OK);
    return texels;
}

inline constexpr const char* kDecaying =
    "context decay = 0\nHouse -> Extrude(wallHeight) {NULL, Top}\n"
    "Top -> Join(roofHeight, roofPos1, roofPos2) {Cover, NULL, Top}\n"
    "Cover -> Repeat(XY, vec2(0.3, 0.25), bond) {Tile}\nTile -> Drop(decay) Shape(\"slate\")\n";

// A context without surfaces.
struct Bare {
    FailingDevice device;
    Life life;
    EspContext* context;
    Bare() {
        REQUIRE(life.create(device));
        context = life.context;
    }
};

}  // namespace espalier
