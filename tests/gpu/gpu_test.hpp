#pragma once

#include <doctest/doctest.h>

#include <memory>

#include "runtime/core/check.hpp"
#include "runtime/gpu/commands.hpp"
#include "runtime/gpu/device.hpp"

namespace espalier {

// Prints why and stops the test if there is no value.
template <class T>
T must(Result<T> result) {
    if (!result) FAIL(result.failure().text());
    return std::move(*result);
}

inline DeviceOptions validated() {
    DeviceOptions options;
    options.applicationName = "test_gpu";
    options.validation = true;
    options.synchronizationValidation = true;
    return options;
}

// A validated device; the end of the test checks that the layer had nothing to say.
struct TestDevice {
    std::unique_ptr<Device> owner = must(Device::create(validated()));
    Device& device = *owner;
    ~TestDevice() {
        CHECK(device.waitIdle());
        CHECK(device.validationMessages() == 0);
    }
};

struct FillPush {
    uint64_t words;
    uint32_t count;
    uint32_t factor = 1;
    uint32_t repeat = 0;
};

}  // namespace espalier
