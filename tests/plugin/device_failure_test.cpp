// What a host meets when the driver fails: every step of a context's life either works or gives an error code and a
// message, memory that was short for a moment costs nothing that stood before, and what is left can be destroyed.
#include <doctest/doctest.h>

#include <algorithm>
#include <cstdlib>
#include <string>

#include "tests/plugin/life.hpp"

using namespace espalier;
using Fault = FailingDevice::Failure;

namespace {

// A spread of the calls; all of them with ESPALIER_EVERY_FAILURE=1, which takes minutes.
uint32_t stride(uint32_t calls, uint32_t samples) {
    return std::getenv("ESPALIER_EVERY_FAILURE") ? 1 : std::max(1u, calls / samples);
}

uint32_t callsOfWholeLife(FailingDevice& device, Fault how) {
    device.failAt(UINT32_MAX, how);
    Life life;
    REQUIRE(life.all(device));
    return device.calls();
}

}  // namespace

TEST_CASE("A lost device gives a code and a message at every step, and can be destroyed") {
    FailingDevice device;
    const uint32_t calls = callsOfWholeLife(device, Fault::Lost);
    REQUIRE(calls > 10);
    for (uint32_t at = 0; at < calls; at += stride(calls, 5)) {
        Life life;
        device.failAt(at, Fault::Lost);
        const bool whole = life.all(device);
        CAPTURE(at);
        CAPTURE(device.failed());
        CAPTURE(life.failedStep);
        // A loss that only a poll has met is told by the next call.
        if (whole)
            CHECK((device.failed() == "vkGetQueryPoolResults" || device.failed() == "vkGetSemaphoreCounterValue"));
        if (!whole) {
            CHECK(life.result == ESP_DEVICE_LOST);
            const std::string message = espLastError(life.context);
            CAPTURE(message);
            CHECK(message.find("lost") != std::string::npos);
        }
        // It stays lost: no later call may hang, crash or pretend.
        if (life.context && life.grammar.id) {
            life.plant(2);
            CHECK_FALSE((life.update() && life.draw() && life.read()));
            CHECK(life.result == ESP_DEVICE_LOST);
        }
    }
    device.heal();
    Life after;
    CHECK(after.all(device));
}

TEST_CASE("Memory that runs out once costs the call that needed it, and nothing that stood") {
    FailingDevice device;
    const uint32_t calls = callsOfWholeLife(device, Fault::OutOfMemory);
    REQUIRE(calls > 50);
    uint64_t hash = 0;
    {
        Life life;
        REQUIRE(life.all(device));
        hash = life.stats().hash;
    }
    for (uint32_t at = 0; at < calls; at += stride(calls, 7)) {
        Life life;
        device.failAt(at, Fault::OutOfMemory);
        const bool whole = life.all(device);
        CAPTURE(at);
        CAPTURE(device.failed());
        CAPTURE(life.failedStep);
        REQUIRE_FALSE(device.failed().empty());
        if (!whole) {
            CHECK(life.result == (life.context || at > 0 ? ESP_OUT_OF_MEMORY : ESP_NO_DEVICE));
            const std::string message = espLastError(life.context);
            CAPTURE(message);
            CHECK(message.find("memory") != std::string::npos);
        }
        // The same steps again, from the one that failed, end where a life without failures ends.
        if (!life.context) CHECK(life.create(device));
        if (!life.surface.id) CHECK(life.load());
        if (!life.grammar.id) CHECK(life.compile());
        if (!life.seed.id) CHECK(life.plant(1));
        CHECK(life.update());
        CHECK(life.draw());
        CHECK(life.read());
        CHECK(life.stats().hash == hash);
    }
}

TEST_CASE("Memory that runs out in a regrowth leaves the last plant standing") {
    FailingDevice device;
    Life life;
    REQUIRE(life.all(device));
    const EspStats before = life.stats();
    device.failAt(UINT32_MAX, Fault::OutOfMemory);
    const float longer = 3, shorter = .3f;
    REQUIRE(espSetParam(life.context, life.grammar, "reach", &longer, 1) == ESP_OK);
    REQUIRE(life.update());
    const uint32_t calls = device.calls();
    const uint64_t grown = life.stats().hash;
    REQUIRE(grown != before.hash);
    REQUIRE(espSetParam(life.context, life.grammar, "reach", &shorter, 1) == ESP_OK);
    REQUIRE(life.update());
    REQUIRE(life.stats().hash == before.hash);

    for (uint32_t at = 0; at < calls; at += stride(calls, 4)) {
        Life fresh;
        device.heal();
        REQUIRE(fresh.all(device));
        REQUIRE(espSetParam(fresh.context, fresh.grammar, "reach", &longer, 1) == ESP_OK);
        device.failAt(at, Fault::OutOfMemory);
        const bool updated = fresh.update();
        CAPTURE(at);
        CAPTURE(device.failed());
        if (!updated) {
            CHECK(fresh.result == ESP_OUT_OF_MEMORY);
            CHECK(fresh.stats().hash == before.hash);
            CHECK(fresh.draw());
            CHECK(fresh.update());  // tried again, since the parameter still waits
        }
        CHECK(fresh.stats().hash == grown);
    }
}
