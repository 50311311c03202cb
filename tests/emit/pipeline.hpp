#pragma once

#include <doctest/doctest.h>

#include <cstring>
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

inline EmitView fullDetail() {
    EmitView view{};
    view.flags = kFullDetail;
    view.lodPixels = 1;
    return view;
}

// An emission on a device whose validation layer has to be silent to the end.
struct EmitPipeline {
    std::shared_ptr<Device> device;
    Terminals terminals;
    Emit emit;

    explicit EmitPipeline(std::shared_ptr<Device> on = validatedDevice(), TerminalData meshes = simpleTerminals())
        : device(std::move(on)) {
        Result<Terminals> t = Terminals::create(*device, std::move(meshes));
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

// The same draws of the same instances.
inline void compareDrawn(Device& device, EmitPipeline& often, const EmitState& part, EmitPipeline& once,
                         const EmitState& whole) {
    CHECK(part.fullTriangles == whole.fullTriangles);
    CHECK(std::memcmp(part.counts, whole.counts, sizeof part.counts) == 0);
    CHECK(std::memcmp(part.draws, whole.draws, sizeof part.draws) == 0);
    const auto drawn = [&](EmitPipeline& p) {
        return *readVector<DrawnItem>(device, p.emit.drawn(), 0, whole.spanCount + whole.leafCount);
    };
    const auto a = drawn(often), b = drawn(once);
    CHECK(std::memcmp(a.data(), b.data(), a.size() * sizeof(DrawnItem)) == 0);
    const auto sameInstances = [&](const Buffer& x, const Buffer& y, size_t bytes, bool spans) {
        const auto p = *readVector<std::byte>(device, x, 0, x.size());
        const auto q = *readVector<std::byte>(device, y, 0, y.size());
        size_t others = 0;
        for (size_t i = 0; i < a.size(); ++i)
            if ((i < whole.spanCount) == spans)
                others += std::memcmp(&p[a[i].item * bytes], &q[a[i].item * bytes], bytes) != 0;
        return others == 0;
    };
    CHECK(sameInstances(often.emit.spanInstances(), once.emit.spanInstances(), sizeof(SpanInstance), true));
    CHECK(sameInstances(often.emit.leafInstances(), once.emit.leafInstances(), sizeof(LeafInstance), false));
}

}  // namespace espalier::test
