// Calls that the host has no memory for, at any point of them: they fail, and all is as it was.
#include <doctest/doctest.h>

#include <cstring>
#include <utility>
#include <vector>

#include "plugin_api/espalier.hpp"
#include "tests/plugin/life.hpp"
#include "tests/plugin/starving.hpp"

using namespace espalier;

TEST_CASE("a surface that the host has no memory to move stands where it stood, and its plants on it") {
    FailingDevice device;
    Life life;
    REQUIRE(life.all(device));
    const uint64_t hash = life.stats().hash;
    const auto standsAt = [&] {
        EspSurfaceInfo surface{};
        EspSeedDef seed{};
        REQUIRE(espSurfaceInfo(life.context, life.surface, &surface) == ESP_OK);
        REQUIRE(espSeedDef(life.context, life.seed, &seed) == ESP_OK);
        return std::pair(surface.boundsMin[0], seed.position[0]);
    };
    const auto before = standsAt();
    EspTransform place = espIdentity();
    place.rows[0][3] = 2;
    uint32_t failures = 0;
    for (uint32_t at = 0;; ++at, ++failures) {
        CAPTURE(at);
        const EspResult result = with(at, [&] { return espMoveSurface(life.context, life.surface, &place); });
        if (result == ESP_OK) break;
        REQUIRE(result == ESP_OUT_OF_MEMORY);
        CHECK(standsAt() == before);
        REQUIRE(life.update());
        CHECK(life.stats().hash == hash);
    }
    CHECK(failures > 0);
    CHECK(standsAt() == std::pair(before.first + 2, before.second + 2));
}

TEST_CASE("a town's layer that the host has no memory to set is as it was, or there is none") {
    constexpr const char* kTown = "{\"buildings\": [{\"id\": \"h\", \"outer\": [[0,0],[10,0],[10,8],[0,8]]}]}";
    constexpr const char* kLayer = "mossOfManyLetters";
    FailingDevice device;
    Life life;
    REQUIRE(life.create(device));
    EspTownDef town = esp::defaults<EspTownDef>();
    town.text = kTown;
    town.length = std::strlen(kTown);
    REQUIRE(espLoadTown(life.context, &town) == ESP_OK);
    const float half[4] = {.2f, .4f, .6f, .8f}, other[4] = {.1f, .5f, .5f, .9f};
    uint32_t layers = 0;
    SUBCASE("of which there is none") {}
    SUBCASE("that was set before") {
        REQUIRE(espSetTownLayer(life.context, kLayer, half, 2, 2, nullptr) == ESP_OK);
        layers = 1;
    }
    uint32_t side = 0;
    REQUIRE(espReadTownLayer(life.context, kLayer, nullptr, &side) == ESP_OK);
    const auto texels = [&] {
        std::vector<float> all(size_t(side) * side);
        REQUIRE(espReadTownLayer(life.context, kLayer, all.data(), &side) == ESP_OK);
        return all;
    };
    const std::vector<float> before = texels();
    EspStroke stroke{};
    uint32_t failures = 0;
    for (uint32_t at = 0;; ++at, ++failures) {
        CAPTURE(at);
        const EspResult result = with(at, [&] { return espSetTownLayer(life.context, kLayer, other, 2, 2, &stroke); });
        if (result == ESP_OK) break;
        REQUIRE(result == ESP_OUT_OF_MEMORY);
        CHECK(espTownLayerCount(life.context) == layers);
        CHECK(texels() == before);
    }
    CHECK(failures > 3);
    CHECK(texels() != before);
    REQUIRE(espSwapStroke(life.context, stroke) == ESP_OK);
    CHECK(texels() == before);
}
