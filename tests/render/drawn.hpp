#pragma once

#include <doctest/doctest.h>

#include <cstdlib>
#include <memory>
#include <vector>

#include "runtime/render/renderer.hpp"
#include "tests/emit/fixture.hpp"

namespace espalier::test {

// Pictures by a renderer on a device of their own, which the validation layer says nothing of.
class Drawn {
  public:
    Drawn() {
        DeviceOptions options;
        options.validation = std::getenv("ESPALIER_NO_VALIDATION") == nullptr;
        auto device = Device::create(options);
        REQUIRE(device);
        device_ = std::move(*device);
        auto renderer = Renderer::create(*device_, simpleTerminals());
        REQUIRE(renderer);
        renderer_ = std::move(*renderer);
        inputs.look.shadows = false;
    }
    ~Drawn() { CHECK(device_->validationMessages() == 0); }

    // RGBA, rows top to bottom.
    std::vector<uint8_t> frame(uint32_t width, uint32_t height) {
        auto commands = Commands::begin(*device_, "frame");
        REQUIRE(commands);
        DrawTarget target;
        target.width = width, target.height = height;
        REQUIRE(renderer_->draw(*commands, inputs, target));
        REQUIRE(commands->finish());
        auto pixels = renderer_->readPixels();
        REQUIRE(pixels);
        return std::move(*pixels);
    }
    Device& device() { return *device_; }
    Renderer& renderer() { return *renderer_; }

    DrawInputs inputs;

  private:
    std::unique_ptr<Device> device_;
    std::unique_ptr<Renderer> renderer_;
};

}  // namespace espalier::test
