// What too little memory costs a context: growth that doesn't fit is seldom tried again and leaves nothing behind, a
// town and plants fail each for itself, undo takes back what was painted and no more.
#include <doctest/doctest.h>

#include <cmath>
#include <cstring>
#include <utility>
#include <vector>

#include "plugin_api/espalier.hpp"
#include "tests/plugin/life.hpp"
#include "tests/plugin/town_host.hpp"

using namespace espalier;
using Fault = FailingDevice::Failure;

namespace {

constexpr const char* kThicket =
    "param leaves = 1 [1 .. 64]\n"
    "Ivy -> Branch(8) {Stem, Stem, Stem, Stem, Stem, Stem, Stem, Stem}\n"
    "Stem : arc >= 0.9 -> NULL\n"
    "Stem -> Marching(0.002, rand(-0.3, 0.3), true) {Stem, Foliage}\n"
    "Foliage -> Tuft Tuft Tuft Tuft\n"
    "Tuft -> Repeat(leaves) {S(0.06) T(rand(), 0.02) Shape(\"leaf\")}\n";

constexpr const char* kTown =
    "{\"buildings\": [{\"id\": \"h\", \"outer\": [[0,0],[10,0],[10,8],[0,8]]},"
    " {\"id\": \"i\", \"outer\": [[20,0],[30,0],[30,8],[20,8]]}]}";
constexpr const char* kRoofs =
    "context decay = 0\n"
    "House -> Extrude(wallHeight) {NULL, Top}\n"
    "Top -> Join(roofHeight, roofPos1, roofPos2) {Cover, NULL, Top}\n"
    "Cover -> Repeat(XY, vec2(0.3, 0.25), bond) {Tile}\n"
    "Tile -> Drop(decay) Shape(\"slate\")\n";

// Next time all grows anew.
void growAnew(EspContext* context, uint32_t maxDepth) {
    EspGrowDef grow = esp::defaults<EspGrowDef>();
    grow.maxDepth = maxDepth;
    REQUIRE(espSetGrow(context, &grow) == ESP_OK);
}

EspStroke begin(EspContext* context, const char* layer, EspBrushMode mode, float radius) {
    EspBrush brush = esp::defaults<EspBrush>();
    brush.layer = layer;
    brush.mode = mode;
    brush.radius = radius;
    brush.strength = brush.hardness = 1;
    EspStroke stroke{};
    REQUIRE(espBeginStroke(context, &brush, &stroke) == ESP_OK);
    return stroke;
}
EspResult dab(EspContext* context, EspStroke stroke, float x, float y, float z) {
    const EspDab at = {{x, y, z}, {0, 0, 1}, 1};
    return espStrokeDabs(context, stroke, &at, 1);
}

std::vector<float> layerOf(Life& life, const char* name, EspSurface surface) {
    uint32_t side = 0;
    REQUIRE(espReadLayer(life.context, surface, name, nullptr, &side) == ESP_OK);
    std::vector<float> texels(size_t(side) * side);
    REQUIRE(espReadLayer(life.context, surface, name, texels.data(), &side) == ESP_OK);
    return texels;
}
std::vector<float> layerOf(Life& life, const char* name) {
    return layerOf(life, name, life.surface);
}
std::vector<float> townLayerOf(Life& life, const char* name) {
    uint32_t side = 0;
    REQUIRE(espReadTownLayer(life.context, name, nullptr, &side) == ESP_OK);
    std::vector<float> texels(size_t(side) * side);
    REQUIRE(espReadTownLayer(life.context, name, texels.data(), &side) == ESP_OK);
    return texels;
}

uint32_t drawnTiles(Life& life) {
    esp::DrawDef def;
    def.width = def.height = 256;
    const float eye[3] = {5, 20, -4}, target[3] = {5, 0, -4.1f};
    std::memcpy(def.camera.eye, eye, sizeof eye);
    std::memcpy(def.camera.target, target, sizeof target);
    def.look.shadows = 0;
    REQUIRE(espDraw(life.context, &def) == ESP_OK);
    EspRoofStats stats{};
    REQUIRE(espReadRoofStats(life.context, &stats) == ESP_OK);
    return stats.drawnTiles;
}

}  // namespace

TEST_CASE("growth too large for memory is tried ever less often, and what is small again grows") {
    FailingDevice device;
    Life life;
    REQUIRE((life.create(device) && life.load()));
    life.grammar = compiled(life.context, "thicket", kThicket);
    for (uint32_t number = 1; number < 9; ++number) REQUIRE(life.plant(number));
    REQUIRE(life.update());
    growAnew(life.context, 4000);
    REQUIRE(life.update());  // both sets of buffers are there now
    const uint64_t hash = life.stats().hash;

    device.failAt(0, Fault::Full);
    const float many = 64, few = 1;
    REQUIRE(espSetParam(life.context, life.grammar, "leaves", &many, 1) == ESP_OK);
    growAnew(life.context, 4096);
    REQUIRE_FALSE(life.update());
    CHECK(life.result == ESP_OUT_OF_MEMORY);
    const uint32_t once = device.calls();
    REQUIRE(once > 0);
    for (int frame = 0; frame < 31; ++frame) {
        REQUIRE_FALSE(life.update());
        CHECK(life.result == ESP_OUT_OF_MEMORY);
        CHECK(std::string(espLastError(life.context)).find("memory") != std::string::npos);
    }
    CHECK(device.calls() > once);  // memory might have come back
    // After 1, 2, 4, 8, 16 calls; these tries ask for more, since the first began with buffers that there were.
    CHECK(device.calls() <= 10 * once);
    CHECK(life.stats().hash == hash);  // the last good growth stands

    REQUIRE(espSetParam(life.context, life.grammar, "leaves", &few, 1) == ESP_OK);
    growAnew(life.context, 4000);
    CHECK_MESSAGE(life.update(), espLastError(life.context));
    CHECK(life.stats().hash == hash);
}

TEST_CASE("plants grow where the town fails, and what was painted on it isn't lost") {
    FailingDevice device;
    Life life;
    REQUIRE(life.all(device));
    const float longer = 3;
    const EspGrammar roofs = compiled(life.context, "roofs", kRoofs);
    EspTownDef town = esp::defaults<EspTownDef>();
    town.text = kTown;
    town.length = std::strlen(kTown);
    town.grammar = roofs;
    REQUIRE(espLoadTown(life.context, &town) == ESP_OK);
    const uint64_t before = life.stats().hash;
    REQUIRE(espSetParam(life.context, life.grammar, "reach", &longer, 1) == ESP_OK);
    device.failAt(0, Fault::OutOfMemory);
    CHECK_FALSE(life.update());
    CHECK(life.result == ESP_OUT_OF_MEMORY);
    CHECK(std::string(espLastError(life.context)).find("memory") != std::string::npos);
    CHECK(life.stats().hash != before);
    REQUIRE(life.update());
    const uint32_t whole = drawnTiles(life);
    REQUIRE(whole > 500);

    const EspStroke stroke = begin(life.context, "decay", ESP_BRUSH_PAINT, 2);
    REQUIRE(dab(life.context, stroke, 5, 40, -4) == ESP_OK);
    device.failAt(0, Fault::OutOfMemory);
    CHECK_FALSE(life.update());
    REQUIRE(life.update());
    CHECK(drawnTiles(life) < whole - 50);
    REQUIRE(espEndStroke(life.context, stroke) == ESP_OK);
}

TEST_CASE("houses whose growth fails, and the whole town's after it, are drawn as they were") {
    // Forty-five houses about the origin and fifty far away. Painted ones have a record for each cell, for which there
    // is no room yet.
    std::string town = "{\"buildings\": [";
    for (int i = 0; i < 95; ++i) {
        const int x = i % 7 * 14 + (i < 45 ? 0 : 1000), y = (i < 45 ? i : i - 45) / 7 * 14;
        char house[160];
        std::snprintf(house, sizeof house, "%s{\"id\": \"%d\", \"outer\": [[%d,%d],[%d,%d],[%d,%d],[%d,%d]]}",
                      i > 0 ? "," : "", i, x, y, x + 10, y, x + 10, y + 8, x, y + 8);
        town += house;
    }
    town += "]}";
    constexpr const char* kCells =
        "context decay = 0\n"
        "House -> Extrude(wallHeight) {NULL, Top}\n"
        "Top -> Join(roofHeight, roofPos1, roofPos2) {Cover, NULL, Top}\n"
        "Cover : decay(house) > 0.5 -> Repeat(XY, vec2(0.3, 0.25), fit) {Cell}\n"
        "Cover -> Repeat(XY, vec2(0.3, 0.25), fit) {Tile}\n"
        "Cell -> Tint(rand()) Shape(\"slate\")\n"
        "Tile -> Shape(\"slate\")\n";
    // The function that failed at this call of an update after a dab.
    uint32_t calls = 0;
    uint64_t whole = 0;  // hash of the town where nothing fails
    const auto failingAt = [&](uint32_t at) {
        CAPTURE(at);
        FailingDevice device;
        Life life;
        REQUIRE(life.create(device));
        EspTownDef def = esp::defaults<EspTownDef>();
        def.text = town.c_str();
        def.length = town.size();
        def.grammar = compiled(life.context, "cells", kCells);
        REQUIRE(espLoadTown(life.context, &def) == ESP_OK);
        REQUIRE(life.update());
        const uint32_t before = drawnTiles(life);
        REQUIRE(before > 500);
        const EspStroke stroke = begin(life.context, "decay", ESP_BRUSH_PAINT, 90);
        REQUIRE(dab(life.context, stroke, 45, 40, -45) == ESP_OK);
        device.failAt(at, Fault::OutOfMemory);
        life.update();
        calls = device.calls();
        const std::string function = device.failed();
        CAPTURE(function);
        // Memory that there was none for at first is asked for again, when what was kept has been given back.
        const bool recovers = life.result == ESP_OK;
        CHECK((!recovers || function.empty() || function == "vkAllocateMemory" || function == "vkMapMemory"));
        CHECK((recovers || !function.empty()));
        if (recovers) {  // then nothing is missing
            EspRoofStats stats{};
            REQUIRE(espReadRoofStats(life.context, &stats) == ESP_OK);
            if (function.empty()) whole = stats.hash;
            CHECK(stats.hash == whole);
        }
        device.heal();
        CHECK(drawnTiles(life) > before - 50);
        CHECK_MESSAGE(life.update(), espLastError(life.context));
        CHECK(drawnTiles(life) > before - 50);
        REQUIRE(espEndStroke(life.context, stroke) == ESP_OK);
        return recovers ? std::string() : function;
    };
    CHECK(failingAt(UINT32_MAX).empty());
    const uint32_t all = calls;
    uint32_t failures = 0;
    for (uint32_t part = 0; part < 4; ++part)
        for (uint32_t at = (2 * part + 1) * all / 8; at < all; ++at)
            if (!failingAt(at).empty()) {
                ++failures;
                break;
            }
    CHECK(failures == 4);
}

TEST_CASE("a dab that memory ran short for is no part of what undo takes back") {
    FailingDevice device;
    Life life;
    REQUIRE((life.create(device) && life.load()));
    const auto layer = [&] { return layerOf(life, "mask"); };
    for (EspBrushMode mode : {ESP_BRUSH_PAINT, ESP_BRUSH_SMOOTH}) {
        CAPTURE(mode);
        const EspStroke spots = begin(life.context, "mask", ESP_BRUSH_PAINT, .1f);
        for (float x : {.2f, .5f, .8f}) REQUIRE(dab(life.context, spots, x, .5f, 0) == ESP_OK);
        REQUIRE(espEndStroke(life.context, spots) == ESP_OK);
        const std::vector<float> before = layer();
        uint32_t failures = 0;
        for (uint32_t at = 0; at < 100; ++at) {
            CAPTURE(at);
            const EspStroke stroke = begin(life.context, "mask", mode, .25f);
            REQUIRE(dab(life.context, stroke, .15f, .45f, 0) == ESP_OK);
            device.failAt(at, Fault::OutOfMemory);
            const EspResult result = dab(life.context, stroke, .85f, .55f, 0);
            const bool failed = !device.failed().empty();
            device.heal();
            CHECK(result == (failed ? ESP_OUT_OF_MEMORY : ESP_OK));
            REQUIRE(espEndStroke(life.context, stroke) == ESP_OK);
            REQUIRE(layer() != before);
            REQUIRE(espSwapStroke(life.context, stroke) == ESP_OK);
            REQUIRE(layer() == before);
            if (!failed) break;
            failures += 1;
        }
        CHECK(failures > 3);
    }
}

TEST_CASE("a fill or an import that memory ran short for has done nothing, on the town neither") {
    FailingDevice device;
    Life life;
    REQUIRE((life.create(device) && life.load()));
    life.grammar =
        compiled(life.context, "ivy", "context decay = 0\nIvy -> Marching(0.05, 0, decay(texCoord) < 0.5) {Ivy}\n");
    EspTownDef town = esp::defaults<EspTownDef>();
    town.text = kTown;
    town.length = std::strlen(kTown);
    town.grammar = compiled(life.context, "roofs", kRoofs);
    REQUIRE(espLoadTown(life.context, &town) == ESP_OK);
    REQUIRE((life.plant(1) && life.update()));
    const EspStroke spot = begin(life.context, "decay", ESP_BRUSH_PAINT, .2f);
    REQUIRE(dab(life.context, spot, .5f, .5f, 0) == ESP_OK);
    REQUIRE(espEndStroke(life.context, spot) == ESP_OK);
    REQUIRE(life.update());
    const std::vector<float> surface = layerOf(life, "decay"), roofs = townLayerOf(life, "decay");
    const uint64_t hash = life.stats().hash;
    const std::vector<float> picture(surface.size(), .25f);
    EspLayerDef def = esp::defaults<EspLayerDef>();
    def.surface = life.surface;
    def.name = "decay";
    def.texels = picture.data();
    def.space = ESP_LAYER_TEXELS;
    def.width = def.height = uint32_t(std::lround(std::sqrt(double(picture.size()))));
    for (const bool fills : {true, false}) {
        CAPTURE(fills);
        uint32_t failures = 0;
        for (uint32_t at = 0; at < 100; ++at) {
            CAPTURE(at);
            EspStroke stroke{};
            device.failAt(at, Fault::OutOfMemory);
            const EspResult result = fills ? espFillLayer(life.context, "decay", .75f, &stroke)
                                           : espImportLayer(life.context, &def, &stroke);
            const bool failed = !device.failed().empty();
            device.heal();
            if (result != ESP_OK) {
                CHECK(result == ESP_OUT_OF_MEMORY);
                failures += 1;
            } else {  // which it may be with a record that is larger than it has to be
                CHECK(layerOf(life, "decay") != surface);
                REQUIRE(espSwapStroke(life.context, stroke) == ESP_OK);
                REQUIRE(espDestroyStroke(life.context, stroke) == ESP_OK);
            }
            REQUIRE(layerOf(life, "decay") == surface);
            REQUIRE(townLayerOf(life, "decay") == roofs);
            REQUIRE(life.update());
            REQUIRE(life.stats().hash == hash);
            if (!failed) break;
        }
        CHECK(failures > 3);
    }
}

TEST_CASE("undo that memory ran short for has done nothing, and does all the next time") {
    FailingDevice device;
    Life life;
    REQUIRE((life.create(device) && life.load()));
    EspTransform beside = espIdentity();
    beside.rows[0][3] = 1.2f;
    EspSurface second{};
    REQUIRE(espLoadSurface(life.context, ESPALIER_SQUARE, &beside, &second) == ESP_OK);
    const auto layers = [&] { return std::pair(layerOf(life, "mask"), layerOf(life, "mask", second)); };
    const EspStroke stroke = begin(life.context, "mask", ESP_BRUSH_PAINT, .5f);
    const auto before = layers();
    REQUIRE(dab(life.context, stroke, 1.1f, .5f, 0) == ESP_OK);
    REQUIRE(espEndStroke(life.context, stroke) == ESP_OK);
    const auto painted = layers();
    REQUIRE(painted.first != before.first);
    REQUIRE(painted.second != before.second);
    uint32_t failures = 0;
    for (uint32_t at = 0; at < 100; ++at) {
        CAPTURE(at);
        device.failAt(at, Fault::OutOfMemory);
        const EspResult result = espSwapStroke(life.context, stroke);
        const bool failed = !device.failed().empty();
        device.heal();
        CHECK((result != ESP_OK) == failed);
        REQUIRE((layers() == (failed ? painted : before)));
        if (!failed) break;
        failures += 1;
    }
    CHECK(failures > 3);
    REQUIRE(espSwapStroke(life.context, stroke) == ESP_OK);
    CHECK((layers() == painted));
}
