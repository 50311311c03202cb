// Shadows after edits of growth: only tiles are redrawn, and pictures are to the byte those of a renderer that has
// never seen the growth before.
#include <doctest/doctest.h>

#include "runtime/render/renderer.hpp"
#include "tests/emit/edited.hpp"
#include "tests/emit/pipeline.hpp"
#include "tests/render/wall.hpp"

using namespace espalier;

namespace {

struct Painter {
    explicit Painter(Device& on) : device(on) {
        Result<std::unique_ptr<Renderer>> made = Renderer::create(device, test::simpleTerminals());
        REQUIRE(made);
        renderer = std::move(*made);
        REQUIRE(renderer->setSurface(0, test::wall(4, 2.6f), glm::mat4(1)));
    }
    std::vector<uint8_t> draw(const DrawInputs& inputs) {
        Result<Commands> commands = Commands::begin(device, "frame");
        REQUIRE(commands);
        REQUIRE(renderer->draw(*commands, inputs, {.width = 320, .height = 240}));
        REQUIRE(commands->finish());
        Result<std::vector<uint8_t>> pixels = renderer->readPixels();
        REQUIRE(pixels);
        return std::move(*pixels);
    }
    Device& device;
    std::unique_ptr<Renderer> renderer;
};

// The growth of two edits, as renderers are given it.
struct Growing {
    explicit Growing(Device& on) : device(on) {
        plant.view.nodeBuffer = &plant.nodes;
        plant.view.chunkBuffer = &plant.chunks;
        plant.view.leafBuffer = &plant.leaves;
        plant.view.touched = &touched;
        plant.view.number = plant.view.renewed = 1;
        inputs.surfaces = plant.surfaceBuf;
        inputs.camera = {.eye = {0.9f, 1.1f, 2.6f}, .target = {0.1f, 0.9f, 0}};
        show(0);
    }
    // 0: as it was; 1, 2: after so many edits.
    void show(int edits) {
        test::rewrite(device, plant, touched,
                      edits == 0   ? e.before
                      : edits == 1 ? e.after
                                   : e.last,
                      edits == 2 ? e.touchedLast : e.touched);
        plant.view.number = uint32_t(edits) + 1;
        inputs.growth = plant.view;
    }
    Device& device;
    test::Edited e = test::edited();
    test::Plant plant = test::upload(device, e.last);
    Buffer touched = std::move(*makeBuffer(device, "touched", e.touchedLast));
    DrawInputs inputs;
};

}  // namespace

TEST_CASE("after edits tiles of the shadows are redrawn, to the same as all of them") {
    const std::shared_ptr<Device> device = test::validatedDevice();
    Growing growing(*device);
    Painter often(*device);
    const std::vector<uint8_t> before = often.draw(growing.inputs);
    for (int edits : {1, 2}) {
        CAPTURE(edits);
        growing.show(edits);
        const std::vector<uint8_t> now = often.draw(growing.inputs);
        CHECK(now != before);
        CHECK(now == Painter(*device).draw(growing.inputs));
        CHECK(often.renderer->stats().shadowsWhole == 1);
        CHECK(often.renderer->stats().shadowsPartly == uint32_t(edits));
    }
    // Shadows of what isn't there for a while, or when the sun has moved, are drawn anew.
    growing.inputs.look.sunDirection.x *= -1;
    CHECK(often.draw(growing.inputs) == Painter(*device).draw(growing.inputs));
    CHECK(often.renderer->stats().shadowsWhole == 2);
    const GrowthView growth = std::exchange(growing.inputs.growth, {});
    often.draw(growing.inputs);
    growing.inputs.growth = growth;
    CHECK(often.draw(growing.inputs) == Painter(*device).draw(growing.inputs));
    CHECK(often.renderer->stats().shadowsWhole == 4);
    CHECK(often.renderer->stats().shadowsPartly == 2);
    CHECK(device->validationMessages() == 0);
}

TEST_CASE("shadows that lag behind a stroke are right when it ends, without being redrawn whole") {
    const std::shared_ptr<Device> device = test::validatedDevice();
    Growing growing(*device);
    Painter often(*device);
    growing.inputs.look.shadowsLag = true;
    often.draw(growing.inputs);
    // Edits that write the same again follow each other, then others.
    for (int frame = 0; frame < 6; ++frame) {
        growing.show(1);
        often.draw(growing.inputs);
    }
    const RenderStats begun = often.renderer->stats();
    CHECK(begun.shadowsPartly >= 1);
    CHECK(begun.shadowsTaken >= 1);
    growing.show(2);
    const std::vector<uint8_t> right = Painter(*device).draw(growing.inputs);
    // Some tiles at a time they follow while the stroke goes on,
    constexpr uint32_t kFrames = 200;
    uint32_t behind = 0;
    for (uint32_t frame = 0; frame < kFrames; ++frame) {
        growing.show(2);
        behind += often.draw(growing.inputs) != right ? 1 : 0;
    }
    CHECK(behind > 4);
    CHECK(behind < kFrames);
    CHECK(often.draw(growing.inputs) == right);  // and all of them when it ends.
    CHECK(often.renderer->stats().shadowsWhole == 1);
    CHECK(often.renderer->stats().shadowsTaken == begun.shadowsTaken + kFrames / 2);
    CHECK(often.renderer->stats().shadowsPartly == begun.shadowsPartly + 1);
    CHECK(device->validationMessages() == 0);
}

TEST_CASE("shadows that are new in a moving picture are coarse, if they may lag, and right when it rests") {
    const std::shared_ptr<Device> device = test::validatedDevice();
    Growing growing(*device);
    Painter often(*device);
    growing.inputs.look.shadowsLag = true;
    often.draw(growing.inputs);
    const auto whole = [&] { return often.renderer->stats().shadowsWhole; };
    growing.inputs.look.quick = true;
    often.draw(growing.inputs);
    CHECK(whole() == 1);  // fine ones stay
    growing.inputs.look.sunDirection.x *= -1;
    for (int frame = 0; frame < 3; ++frame) often.draw(growing.inputs);
    CHECK(whole() == 2);
    growing.inputs.look.quick = false;
    CHECK(often.draw(growing.inputs) == Painter(*device).draw(growing.inputs));
    CHECK(whole() == 3);
    often.draw(growing.inputs);
    CHECK(whole() == 3);
    CHECK(device->validationMessages() == 0);
}
