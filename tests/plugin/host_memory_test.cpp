// Want of the host's own memory, which a thread of this program can be made to meet.
#include <doctest/doctest.h>

#include <cmath>
#include <cstdlib>
#include <cstring>
#include <string>
#include <utility>
#include <vector>

#include "plugin_api/espalier.hpp"
#include "tests/plugin/life.hpp"
#include "tests/plugin/starving.hpp"

using namespace espalier;

TEST_CASE("growth that the host has no memory for is tried ever less often, and grows when there is some again") {
    constexpr const char* kTown = "{\"buildings\": [{\"id\": \"h\", \"outer\": [[0,0],[10,0],[10,8],[0,8]]}]}";
    constexpr const char* kRoofs = "House -> Extrude(wallHeight) {Wall, NULL}\nWall -> Shape(\"slate\")\n";
    FailingDevice device;
    Life life;
    REQUIRE(life.all(device));
    const uint64_t hash = life.stats().hash;
    const EspGrammarDef roofs = esp::grammarDef("roofs", kRoofs);
    EspTownDef town = esp::defaults<EspTownDef>();
    town.text = kTown;
    town.length = std::strlen(kTown);
    bool ofTown = false;
    SUBCASE("plants") {
        const float longer = 1;
        REQUIRE(espSetParam(life.context, life.grammar, "reach", &longer, 1) == ESP_OK);
    }
    SUBCASE("a town") {
        REQUIRE(espCompileGrammar(life.context, &roofs, &town.grammar) == ESP_OK);
        REQUIRE(life.update());
        REQUIRE(espLoadTown(life.context, &town) == ESP_OK);
        ofTown = true;
    }
    uint32_t once = 0;
    refusals = 0;
    for (int frame = 0; frame < 32; ++frame) {
        const EspResult result = with(0, [&] { return espUpdate(life.context); });
        CHECK(result == ESP_OUT_OF_MEMORY);
        CHECK(std::strstr(espLastError(life.context), "memory"));
        once = once ? once : refusals;
    }
    CHECK(once > 0);
    CHECK(refusals > once);       // memory might have come back
    CHECK(refusals <= 8 * once);  // after 1, 2, 4, 8, 16 calls
    CHECK(life.stats().hash == hash);
    for (int frame = 0; frame < 64 && !life.update();) ++frame;
    CHECK(life.result == ESP_OK);
    CHECK((life.stats().hash != hash) == !ofTown);
    EspRoofStats grown{};
    REQUIRE(espReadRoofStats(life.context, &grown) == ESP_OK);
    CHECK((grown.grids > 0) == ofTown);
}

namespace {

// espUpdate where the thread gets no more than `pieces` of memory; then until it succeeds. Returns whether these were
// enough.
bool updateWith(Life& life, uint32_t pieces) {
    refusals = 0;
    const EspResult result = with(pieces, [&] { return espUpdate(life.context); });
    const bool enough = refusals == 0;
    REQUIRE((result == ESP_OK || (!enough && result == ESP_OUT_OF_MEMORY)));
    for (int frame = 0; frame < 4 && !life.update();) ++frame;
    REQUIRE_MESSAGE(life.result == ESP_OK, espLastError(life.context));
    return enough;
}

uint64_t roofsHash(const Life& life) {
    EspRoofStats stats{};
    REQUIRE(espReadRoofStats(life.context, &stats) == ESP_OK);
    return stats.hash;
}

// `count` houses of twelve corners in rows.
std::string townOf(uint32_t count) {
    std::string text = "{\"buildings\": [";
    for (uint32_t i = 0; i < count; ++i) {
        text += std::string(i > 0 ? "," : "") + "{\"id\": \"" + std::to_string(i) + "\", \"outer\": [";
        for (uint32_t k = 0; k < 12; ++k) {
            const double turn = k * 0.5235987755982988;
            text += std::string(k > 0 ? "," : "") + "[" + std::to_string(14 * (i % 10) + 5 * std::cos(turn)) + "," +
                    std::to_string(14 * (i / 10) + 5 * std::sin(turn)) + "]";
        }
        text += "]}";
    }
    return text + "]}";
}

}  // namespace

TEST_CASE("want of the host's memory at any point of an update costs that update") {
    FailingDevice device;
    Life life;
    REQUIRE(life.all(device));
    // Seeds alone are grown beside what stands, a parameter that all rules use anew.
    bool anew = false;
    SUBCASE("that grows a seed") {}
    SUBCASE("that grows all anew") {
        anew = true;
    }
    uint32_t failures = 0, round = 0;
    for (uint32_t at = 0;; at += 1 + at / 32, ++round) {
        CAPTURE(at);
        EspSeedDef def = esp::defaults<EspSeedDef>();
        def.grammar = life.grammar;
        def.position[0] = .1f + .8f * std::fmod(.618f * float(round), 1.f);
        def.position[1] = .1f + .8f * std::fmod(.271f * float(round), 1.f);
        def.direction[1] = 1;
        def.number = 2 + round;
        EspSeed seed{};
        REQUIRE(espPlant(life.context, &def, &seed) == ESP_OK);
        const float reach = round % 2 ? .1f : .12f;
        if (anew) REQUIRE(espSetParam(life.context, life.grammar, "reach", &reach, 1) == ESP_OK);
        const bool enough = updateWith(life, at);
        failures += enough ? 0 : 1;
        REQUIRE(life.draw());
        const uint64_t hash = life.stats().hash;
        EspGrowDef grow = esp::defaults<EspGrowDef>();
        grow.maxDepth = 4000 + round % 2;
        REQUIRE(espSetGrow(life.context, &grow) == ESP_OK);
        REQUIRE(life.update());
        CHECK(life.stats().hash == hash);
        CHECK(life.stats().seeds == 2 + round);
        if (enough) break;
    }
    CHECK(failures > 10);
}

TEST_CASE("want of the host's memory at any point of a town's update costs that update") {
    constexpr const char* kRoofs =
        "param tile = 0.5 [0.1 .. 5]\n"
        "House -> Extrude(wallHeight) {NULL, Top}\n"
        "Top -> Join(roofHeight, roofPos1, roofPos2) {Cover, NULL, Top}\n"
        "Cover -> Repeat(XY, vec2(tile, 0.5), clip) {Tile}\n"
        "Tile -> Shape(\"slate\")\n";
    uint32_t houses = 0, changed = 0, slower = 0;
    SUBCASE("of which one house changes") {
        houses = 3, changed = 1, slower = 32;
    }
    SUBCASE("whose tables run out of room") {
        houses = 60, changed = 25, slower = 8;
    }
    SUBCASE("of which more houses change than the CPU grows") {
        houses = 90, changed = 40, slower = 4;
    }
    FailingDevice device;
    Life life;
    REQUIRE(life.create(device));
    const EspGrammarDef roofs = esp::grammarDef("roofs", kRoofs);
    const std::string text = townOf(houses);
    EspTownDef town = esp::defaults<EspTownDef>();
    town.text = text.c_str();
    town.length = text.size();
    REQUIRE(espCompileGrammar(life.context, &roofs, &town.grammar) == ESP_OK);
    REQUIRE(espLoadTown(life.context, &town) == ESP_OK);
    const auto shapeTo = [&](bool steep) {
        EspHouseDef def{};
        def.shape = ESP_ROOF_PYRAMID;
        def.slope = steep ? 1 : .7f;
        for (uint32_t house = 0; house < changed; ++house) REQUIRE(espSetHouse(life.context, house, &def) == ESP_OK);
    };
    const auto tileTo = [&](bool wide) {
        const float tile = wide ? .8f : .5f;
        REQUIRE(espSetParam(life.context, town.grammar, "tile", &tile, 1) == ESP_OK);
    };
    uint64_t hashes[2][2];  // [steep][wide]
    for (bool steep : {false, true})
        for (bool wide : {false, true}) {
            shapeTo(steep);
            tileTo(wide);
            REQUIRE(life.update());
            hashes[steep][wide] = roofsHash(life);
        }
    CHECK(hashes[0][0] != hashes[0][1]);
    CHECK(hashes[0][0] != hashes[1][0]);
    bool steep = true, wide = true;
    uint32_t failures = 0;
    for (uint32_t at = 0, enough = 0; enough != 3; at += 1 + at / slower) {
        CAPTURE(at);
        steep = !steep;
        shapeTo(steep);
        enough = updateWith(life, at) ? 1 : 0;
        CHECK(roofsHash(life) == hashes[steep][wide]);
        wide = !wide;  // all houses, from the tables that the GPU has been sent
        tileTo(wide);
        enough |= updateWith(life, at) ? 2 : 0;
        CHECK(roofsHash(life) == hashes[steep][wide]);
        failures += enough != 3;
    }
    CHECK(failures > 10);
}

TEST_CASE("a seed that the host has no memory for is planted as it was asked for when there is some again") {
    FailingDevice device;
    Life life;
    REQUIRE(life.all(device));
    EspSeed seed{};
    EspSeedDef def = esp::defaults<EspSeedDef>();
    def.grammar = life.grammar;
    def.number = 9;
    def.twin = 1;
    EspResult result = ESP_OUT_OF_MEMORY;
    uint32_t pieces = 0;
    for (; pieces < 100 && result == ESP_OUT_OF_MEMORY; ++pieces) {
        REQUIRE(espSeedCount(life.context) == 1);
        result = with(pieces, [&] { return espPlant(life.context, &def, &seed); });
    }
    CHECK(result == ESP_OK);  // no try before took the twin
    CHECK(pieces > 2);
    CHECK(espSeedCount(life.context) == 2);
}

TEST_CASE("a surface that the host has no memory for is neither drawn nor kept") {
    constexpr uint32_t kMany = 10'000'000, kLast = 24;
    FailingDevice device;
    Life life;
    REQUIRE(life.all(device));
    const EspStats before = life.stats();
    EspSurface surface{};
    const auto load = [&](uint32_t pieces) {
        allocationsLeft = pieces;
        const EspResult result = espLoadSurface(life.context, ESPALIER_SQUARE, nullptr, &surface);
        const uint32_t rest = allocationsLeft;
        allocationsLeft = kPlenty;
        if (result == ESP_OK) REQUIRE(espDestroySurface(life.context, surface) == ESP_OK);
        return std::pair(result, pieces - rest);
    };
    const auto [loaded, used] = load(kMany);
    REQUIRE(loaded == ESP_OK);
    uint32_t failures = 0;
    // The last pieces only: of the first, JSON's library asks for some as it takes itself down, which ends the process.
    for (uint32_t missing = 1; missing <= kLast; ++missing) {
        CAPTURE(missing);
        const EspResult result = load(used - missing).first;
        if (result == ESP_OK) continue;
        failures += 1;
        REQUIRE(result == ESP_OUT_OF_MEMORY);
        REQUIRE(life.stats().surfaceBytes == before.surfaceBytes);
        REQUIRE(life.draw());
        REQUIRE(life.stats().modelTriangles == before.modelTriangles);
    }
    CHECK(failures > 0);
}

namespace {

// Ivy that heeds a layer, and other ivy that wants another value of it where nothing is painted.
struct Masked {
    FailingDevice device;
    Life life;
    EspContext* context = nullptr;

    Masked() {
        REQUIRE((life.create(device) && life.load()));
        context = life.context;
        EspSeedDef seed = esp::defaults<EspSeedDef>();
        for (const char* fill : {"1", "0.6"}) {
            const std::string text = std::string("context maskOfManyLetters = ") + fill +
                                     "\nIvy -> Marching(0.05, rand(-0.3, 0.3), "
                                     "arc < 0.8 and maskOfManyLetters(texCoord) > 0.5) {Ivy, Wood}\n"
                                     "Wood -> S(0.01) Shape(\"bark\", C1)\n";
            const EspGrammarDef def = esp::grammarDef("masked", text);
            REQUIRE(espCompileGrammar(context, &def, &seed.grammar) == ESP_OK);
            seed.direction[1] = 1;
            seed.number += 1;
            EspSeed planted{};
            for (int i = 0; i < 4; ++i) {
                seed.position[0] = .1f + .2f * float(i);
                seed.position[1] = .1f;
                REQUIRE(espPlant(context, &seed, &planted) == ESP_OK);
            }
        }
        REQUIRE(life.update());
    }
    // What stands is what growing all anew gives.
    void check(const std::string& when) {
        CAPTURE(when);
        REQUIRE(life.update());
        const uint64_t hash = life.stats().hash;
        EspGrowDef grow = esp::defaults<EspGrowDef>();
        grow.maxDepth = ++depth_;
        REQUIRE(espSetGrow(context, &grow) == ESP_OK);
        REQUIRE(life.update());
        CHECK(life.stats().hash == hash);
    }
    EspResult setLayer(uint32_t pieces, const float* value) {
        EspLayerDef def = esp::defaults<EspLayerDef>();
        def.surface = life.surface;
        def.name = kLayer;
        def.texels = value;
        def.width = def.height = 1;
        return with(pieces, [&] { return espSetLayer(context, &def); });
    }
    static constexpr const char* kLayer = "maskOfManyLetters";

  private:
    uint32_t depth_ = 4000;
};

}  // namespace

TEST_CASE("what want of the host's memory leaves of a dab or a layer that is set, growth hears of") {
    Masked masked;
    const float none = 0;
    bool dabs = true;
    SUBCASE("dabs") {}
    SUBCASE("dabs that are done when they have been submitted") {
        masked.device.finishAtOnce(true);
    }
    SUBCASE("layers") {
        dabs = false;
    }
    uint32_t failures = 0;
    for (uint32_t at = 0;; ++at) {
        CAPTURE(at);
        REQUIRE(masked.setLayer(kPlenty, nullptr) == ESP_OK);
        REQUIRE(masked.life.update());
        EspResult result = ESP_OK;
        if (dabs) {
            EspBrush brush = esp::defaults<EspBrush>();
            brush.layer = Masked::kLayer;
            brush.value = 0;
            brush.strength = 1;
            EspStroke stroke{};
            REQUIRE(espBeginStroke(masked.context, &brush, &stroke) == ESP_OK);
            const EspDab dab{{.3f, .3f, 0}, {0, 0, 1}, 1};
            result = with(at, [&] { return espStrokeDabs(masked.context, stroke, &dab, 1); });
            masked.check("painted");
            REQUIRE(espEndStroke(masked.context, stroke) == ESP_OK);
            REQUIRE(espSwapStroke(masked.context, stroke) == ESP_OK);
            CHECK(espPaintedLayerCount(masked.context) == 0);
        } else {
            result = masked.setLayer(at, &none);
            CHECK(espPaintedLayerCount(masked.context) == (result == ESP_OK ? 1 : 0));
        }
        masked.check(dabs ? "undone" : "set");
        if (result == ESP_OK) break;
        REQUIRE(result == ESP_OUT_OF_MEMORY);
        failures += 1;
    }
    CHECK(failures > 3);
}

TEST_CASE("what a layer was filled with is told without memory") {
    Masked masked;
    EspStroke filled{};
    REQUIRE(espFillLayer(masked.context, Masked::kLayer, .25f, &filled) == ESP_OK);
    float value = 0;
    const int told = with(0, [&] { return espLayerFilled(masked.context, Masked::kLayer, &value); });
    CHECK(told == 1);
    CHECK(value == .25f);
}

TEST_CASE("a seed that the host has no memory to rename, or to give a plant to, is as it was") {
    FailingDevice device;
    Life life;
    REQUIRE(life.all(device));
    const uint64_t hash = life.stats().hash;
    size_t size = 0;
    REQUIRE(espFreezePlant(life.context, life.seed, 1) == ESP_OK);
    REQUIRE(espReadFrozen(life.context, life.seed, nullptr, &size) == ESP_OK);
    std::vector<char> bytes(size);
    REQUIRE(espReadFrozen(life.context, life.seed, bytes.data(), &size) == ESP_OK);
    REQUIRE(espFreezePlant(life.context, life.seed, 0) == ESP_OK);
    REQUIRE(life.update());
    bool renamed = true;
    SUBCASE("to rename") {}
    SUBCASE("to give a plant to") {
        renamed = false;
    }
    uint32_t failures = 0;
    for (uint32_t at = 0;; ++at, ++failures) {
        CAPTURE(at);
        const EspResult result = with(at, [&] {
            return renamed ? espSetSeedNumber(life.context, life.seed, 77 + at, 3)
                           : espFreezeAs(life.context, life.seed, bytes.data(), size);
        });
        EspSeedInfo info{};
        EspSeedDef def{};
        REQUIRE(espSeedInfo(life.context, life.seed, &info) == ESP_OK);
        REQUIRE(espSeedDef(life.context, life.seed, &def) == ESP_OK);
        REQUIRE(life.update());
        if (result == ESP_OK) break;
        REQUIRE(result == ESP_OUT_OF_MEMORY);
        CHECK(def.number == 1);
        CHECK(def.twin == 1);
        CHECK(info.frozen == 0);
        CHECK(life.stats().hash == hash);
    }
    CHECK(failures > 0);
    CHECK((life.stats().hash != hash) == renamed);
}

TEST_CASE("a stroke over a town that the host has no memory for is undone as far as it got") {
    FailingDevice device;
    Life life;
    REQUIRE(life.create(device));
    const std::string text = townOf(3);
    EspTownDef town = esp::defaults<EspTownDef>();
    town.text = text.c_str();
    town.length = text.size();
    REQUIRE(espLoadTown(life.context, &town) == ESP_OK);
    const float half[4] = {.2f, .4f, .6f, .8f};
    REQUIRE(espSetTownLayer(life.context, "moss", half, 2, 2, nullptr) == ESP_OK);
    uint32_t side = 0;
    REQUIRE(espReadTownLayer(life.context, "moss", nullptr, &side) == ESP_OK);
    const auto texels = [&] {
        std::vector<float> all(size_t(side) * side);
        REQUIRE(espReadTownLayer(life.context, "moss", all.data(), &side) == ESP_OK);
        return all;
    };
    const std::vector<float> before = texels();
    EspBrush brush = esp::defaults<EspBrush>();
    brush.layer = "moss";
    brush.radius = 4;
    const EspDab dabs[] = {{{0, 0, 0}, {0, 1, 0}, 1}, {{14, 0, 0}, {0, 1, 0}, 1}, {{6, 0, 2}, {0, 1, 0}, 1}};
    uint32_t failures = 0;
    for (uint32_t at = 0;; ++at, ++failures) {
        CAPTURE(at);
        EspStroke stroke{};
        REQUIRE(espBeginStroke(life.context, &brush, &stroke) == ESP_OK);
        const EspResult result = with(at, [&] { return espStrokeDabs(life.context, stroke, dabs, 3); });
        REQUIRE(espStrokeDabs(life.context, stroke, dabs, 3) == ESP_OK);
        REQUIRE(espEndStroke(life.context, stroke) == ESP_OK);
        CHECK(texels() != before);
        REQUIRE(espSwapStroke(life.context, stroke) == ESP_OK);
        CHECK(texels() == before);
        if (result == ESP_OK) break;
        REQUIRE(result == ESP_OUT_OF_MEMORY);
    }
    CHECK(failures > 2);
}

TEST_CASE("a town whose roofs' meshes the host had no memory to name gets them all the next time") {
    constexpr const char* kRoofs = "House -> Extrude(wallHeight) {Wall, NULL}\nWall -> Shape(\"slate\")\n";
    constexpr uint32_t kMany = 10'000'000;
    const std::string text = townOf(3);
    EspTownDef town = esp::defaults<EspTownDef>();
    town.text = text.c_str();
    // Pieces that an empty town takes, with the meshes and without.
    uint32_t used[2] = {};
    const auto load = [&](Life& life, uint32_t pieces) {
        town.length = 0;
        allocationsLeft = pieces;
        const EspResult result = espLoadTown(life.context, &town);
        const uint32_t rest = allocationsLeft;
        allocationsLeft = kPlenty;
        return std::pair(result, pieces - rest);
    };
    {
        FailingDevice device;
        Life life;
        REQUIRE(life.create(device));
        for (uint32_t& pieces : used) {
            const auto [result, took] = load(life, kMany);
            REQUIRE(result == ESP_INVALID_CONTENT);
            pieces = took;
        }
        REQUIRE(used[0] > used[1] + 4);
    }
    for (uint32_t missing = 1; missing <= 4; ++missing) {
        CAPTURE(missing);
        FailingDevice device;
        Life life;
        REQUIRE(life.create(device));
        REQUIRE(load(life, used[0] - used[1] - missing).first == ESP_OUT_OF_MEMORY);
        const EspGrammarDef roofs = esp::grammarDef("roofs", kRoofs);
        REQUIRE(espCompileGrammar(life.context, &roofs, &town.grammar) == ESP_OK);
        town.length = text.size();
        REQUIRE(espLoadTown(life.context, &town) == ESP_OK);
        REQUIRE(life.update());
        REQUIRE(life.draw());
        EspRoofStats drawn{};
        REQUIRE(espReadRoofStats(life.context, &drawn) == ESP_OK);
        CHECK(drawn.drawnTriangles > 0);
        town.grammar = {};
    }
}
