// What a host meets when the driver fails: every step of a context's life either works or gives an error code and a
// message, memory that was short for a moment costs nothing that stood before, and what is left can be destroyed.
#include <doctest/doctest.h>
#include <vulkan/vulkan_core.h>

#include <algorithm>
#include <cstdlib>
#include <iterator>
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

namespace {

// Of the specification, of extensions and of none; what a host is told of each.
struct OddResult {
    int result;
    EspResult code;
    const char* said;
};
const OddResult kOddResults[] = {
    {VK_ERROR_MEMORY_MAP_FAILED, ESP_DRIVER_FAILED, "driver failed (VK_ERROR_MEMORY_MAP_FAILED)"},
    {VK_ERROR_FORMAT_NOT_SUPPORTED, ESP_DRIVER_FAILED, "driver failed (VK_ERROR_FORMAT_NOT_SUPPORTED)"},
    {VK_ERROR_FRAGMENTED_POOL, ESP_OUT_OF_MEMORY, "out of GPU memory"},
    {VK_ERROR_DEVICE_LOST, ESP_DEVICE_LOST, "lost"},
    {VK_ERROR_UNKNOWN, ESP_DRIVER_FAILED, "driver failed (VK_ERROR_UNKNOWN)"},
    {VK_ERROR_SURFACE_LOST_KHR, ESP_DRIVER_FAILED, "driver failed (VkResult -1000000000)"},
    {-123456789, ESP_DRIVER_FAILED, "driver failed (VkResult -123456789)"},
    {VK_TIMEOUT, ESP_DRIVER_FAILED, "driver failed (VK_TIMEOUT)"},
    {VK_INCOMPLETE, ESP_DRIVER_FAILED, "driver failed (VK_INCOMPLETE)"},
    {VK_PIPELINE_COMPILE_REQUIRED, ESP_DRIVER_FAILED, "driver failed (VK_PIPELINE_COMPILE_REQUIRED)"},
    {77, ESP_DRIVER_FAILED, "driver failed (VkResult 77)"},
};

// Takes the steps that a life still lacks.
bool goOn(Life& life, const FailingDevice& device) {
    if (!life.context && !life.create(device)) return false;
    if (!life.surface.id && !life.load()) return false;
    if (!life.grammar.id && !life.compile()) return false;
    if (!life.seed.id && !life.plant(1)) return false;
    return life.update() && life.draw() && life.read();
}

}  // namespace

TEST_CASE("No result of a driver's ends the process: each is told for what it is, and the next try goes on") {
    FailingDevice device;
    uint64_t hash = 0;
    {
        Life life;
        REQUIRE(life.all(device));
        hash = life.stats().hash;
    }
    const uint32_t rounds = std::getenv("ESPALIER_EVERY_FAILURE") ? uint32_t(std::size(kOddResults)) : 1;
    uint32_t met = 0;
    for (uint32_t round = 0; round < rounds; ++round)
        for (const char* function : FailingDevice::functions()) {
            const OddResult& odd = kOddResults[(met++ + round) % std::size(kOddResults)];
            CAPTURE(function);
            CAPTURE(odd.result);
            Life life;
            device.answerOddly(function, 0, odd.result);
            const bool whole = life.all(device);
            CAPTURE(life.failedStep);
            if (!whole) {
                const bool making = !life.context && life.result == ESP_NO_DEVICE;
                CHECK((making || life.result == odd.code));
                const std::string message = espLastError(life.context);
                CHECK_MESSAGE(message.find(odd.said) != std::string::npos, message);
            }
            if (odd.code == ESP_DEVICE_LOST && life.context) continue;
            for (int i = 0; i < 3 && !goOn(life, device); ++i) continue;  // a failed growth isn't tried at once
            CHECK(life.stats().hash == hash);
        }
}

TEST_CASE("A failed map of memory isn't told as want of memory") {
    FailingDevice device;
    Life life;
    device.answerOddly("vkMapMemory", 0, VK_ERROR_MEMORY_MAP_FAILED);
    CHECK_FALSE(life.create(device));
    CHECK(life.result == ESP_DRIVER_FAILED);
    const std::string message = espLastError(nullptr);
    CHECK_MESSAGE(message.find("VK_ERROR_MEMORY_MAP_FAILED) while mapping its memory") != std::string::npos, message);
    CHECK(message.find("out of") == std::string::npos);
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
