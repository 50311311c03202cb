#pragma once

#include <doctest/doctest.h>

#include <memory>

#include "tests/emit/fixture.hpp"

namespace espalier::test {

inline std::shared_ptr<Device> validatedDevice() {
    DeviceOptions options;
    options.validation = true;
    Result<std::unique_ptr<Device>> made = Device::create(options);
    REQUIRE_MESSAGE(made, (made ? "" : made.failure().text()));
    return std::move(*made);
}

// An emission on a device whose validation layer has to be silent to the end.
struct EmitPipeline {
    std::shared_ptr<Device> device;
    Terminals terminals;
    Emit emit;

    explicit EmitPipeline(std::shared_ptr<Device> on = validatedDevice()) : device(std::move(on)) {
        Result<Terminals> t = Terminals::create(*device, simpleTerminals());
        REQUIRE(t);
        terminals = std::move(*t);
        Result<Emit> e = Emit::create(*device, terminals);
        REQUIRE_MESSAGE(e, (e ? "" : e.failure().text()));
        emit = std::move(*e);
    }
    ~EmitPipeline() {
        for (const std::string& text : device->validationTexts()) MESSAGE(text);
        CHECK(device->validationMessages() == 0);
    }

    EmitState cull(const EmitInputs& inputs, const EmitView& view) {
        Result<Commands> commands = Commands::begin(*device, "cull");
        REQUIRE(commands);
        REQUIRE(emit.cull(*commands, inputs, view, "emit", true));
        REQUIRE(commands->finish());
        return readVector<EmitState>(*device, emit.state(), 0, 1)->at(0);
    }
};

}  // namespace espalier::test
