// Want of the host's own memory, which a thread of this program can be made to meet.
#include <doctest/doctest.h>

#include <cstdlib>
#include <cstring>
#include <new>

#include "tests/plugin/life.hpp"

namespace {

constexpr uint32_t kPlenty = UINT32_MAX;
thread_local uint32_t left = kPlenty;  // pieces of memory that this thread may still have
thread_local uint32_t refusals = 0;

}  // namespace

void* operator new(std::size_t bytes) {
    const bool none = left == 0;
    if (none) ++refusals;
    if (!none && left != kPlenty) --left;
    void* memory = none ? nullptr : std::malloc(bytes > 0 ? bytes : 1);
    return memory ? memory : throw std::bad_alloc();
}
void operator delete(void* memory) noexcept {
    std::free(memory);
}
void operator delete(void* memory, std::size_t) noexcept {
    std::free(memory);
}

using namespace espalier;

TEST_CASE("growth that the host has no memory for is tried ever less often, and grows when there is some again") {
    constexpr const char* kTown = "{\"buildings\": [{\"id\": \"h\", \"outer\": [[0,0],[10,0],[10,8],[0,8]]}]}";
    constexpr const char* kRoofs = "House -> Extrude(wallHeight) {Wall, NULL}\nWall -> Shape(\"slate\")\n";
    FailingDevice device;
    Life life;
    REQUIRE(life.all(device));
    const uint64_t hash = life.stats().hash;
    const EspGrammarDef roofs{"roofs", kRoofs, std::strlen(kRoofs)};
    EspTownDef town = espDefaultTownDef();
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
        left = 0;
        const EspResult result = espUpdate(life.context);
        left = kPlenty;
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

TEST_CASE("want of the host's memory at any point of an update costs that update") {
    FailingDevice device;
    Life life;
    REQUIRE(life.all(device));
    uint32_t failures = 0;
    for (uint32_t at = 0;; at += 1 + at / 32) {
        CAPTURE(at);
        const float reach = at % 2 ? .5f : .6f;
        REQUIRE(espSetParam(life.context, life.grammar, "reach", &reach, 1) == ESP_OK);
        refusals = 0;
        left = at;
        const EspResult result = espUpdate(life.context);
        left = kPlenty;
        failures += refusals > 0;
        REQUIRE((result == ESP_OK || result == ESP_OUT_OF_MEMORY));
        const bool enough = refusals == 0;
        for (int frame = 0; frame < 4 && !life.update();) ++frame;
        REQUIRE_MESSAGE(life.result == ESP_OK, espLastError(life.context));
        REQUIRE(life.draw());
        if (enough) break;
    }
    CHECK(failures > 10);
}
